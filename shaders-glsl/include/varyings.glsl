// What the vertices of boxes and hulls hand their fragments, the same for a whole instance. Vertex shaders define VARYING as `out`.
#ifndef VARYINGS_GLSL
#define VARYINGS_GLSL
#include "look.glsl"
#include "pixel_ray.glsl"

#ifndef VARYING
#define VARYING in
#endif

layout(location = 0) flat VARYING uint instance_index;
layout(location = 1) flat VARYING vec4 ray_eye;    // w: of hulls, a depth near the solid
layout(location = 2) flat VARYING vec4 ray_dir_00; // this and the next two: w as in the frame's block
layout(location = 3) flat VARYING vec4 ray_dir_x;
layout(location = 4) flat VARYING vec4 ray_dir_y;
layout(location = 5) flat VARYING vec4 look_scale_shininess;
layout(location = 6) flat VARYING vec4 look_albedo_strength;
layout(location = 7) flat VARYING vec3 look_ambient;
layout(location = 8) flat VARYING vec4 look_light_0; // towards it; red of its colour
layout(location = 9) flat VARYING vec4 look_light_1; // the same
layout(location = 10) flat VARYING vec4 look_colors; // green and blue of both

#endif
