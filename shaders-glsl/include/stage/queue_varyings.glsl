// Flat varyings of a tile.
#ifndef QUEUE_VARYINGS_GLSL
#define QUEUE_VARYINGS_GLSL
#ifndef VARYING
#define VARYING in
#endif

layout(location = 0) flat VARYING uvec2 tile_queue; // first word, number of copies

#endif
