// Flat varyings of every proxy and tile, the same for a whole instance. Vertex shaders define
// VARYING as `out`, and are compiled so that they pass nothing that no fragment reads.
#ifndef VARYINGS_GLSL
#define VARYINGS_GLSL
#include "core/look.glsl"
#include "core/pixel_ray.glsl"

#ifndef VARYING
#define VARYING in
#endif

layout(location = 1) flat VARYING vec4 ray_origin_base;
layout(location = 2) flat VARYING vec4 ray_dir_00; // w: as in the frame's block; of cells the sense of depth
layout(location = 3) flat VARYING vec4 ray_dir_x;  // this and the next: w as in the frame's block
layout(location = 4) flat VARYING vec4 ray_dir_y;
#if OUTPUT != OUTPUT_DEPTH
layout(location = 0) flat VARYING vec4 look_rotation;
layout(location = 5) flat VARYING vec4 look_scale_shininess;
layout(location = 6) flat VARYING vec4 look_albedo_strength;
layout(location = 7) flat VARYING vec4 look_ambient; // w: the instance's number
layout(location = 8) flat VARYING vec4 look_light_0; // towards it; red of its colour
layout(location = 9) flat VARYING vec4 look_light_1; // the same
layout(location = 10) flat VARYING vec4 look_colors; // green and blue of both
#endif

#endif
