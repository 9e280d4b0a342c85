// The varyings of tiles whose pixels walk a hierarchy: where walks begin. Vertex shaders define VARYING as `out`.
#ifndef WALK_VARYINGS_GLSL
#define WALK_VARYINGS_GLSL
#ifndef VARYING
#define VARYING in
#endif

layout(location = 0) flat VARYING uvec2 walk_root; // index of the root, and of an object
layout(location = 1) flat VARYING uvec4 first_copies;
layout(location = 2) flat VARYING uvec3 goes_on; // node, trail, and depth of the rest

#endif
