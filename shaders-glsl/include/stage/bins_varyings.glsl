// What the vertices of squares of several copies hand their fragments: their list, and all that is the same for a batch.
#ifndef BINS_VARYINGS_GLSL
#define BINS_VARYINGS_GLSL
#include "core/look.glsl"

#ifndef VARYING
#define VARYING in
#endif

layout(location = 0) flat VARYING uvec4 bins_square; // corner in pixels, second and third word of its record
layout(location = 1) flat VARYING vec4 bins_dir_00; // this and the next three as in the frame's block
layout(location = 2) flat VARYING vec4 bins_dir_x;
layout(location = 3) flat VARYING vec4 bins_dir_y;
layout(location = 4) flat VARYING vec4 bins_forward;
layout(location = 5) flat VARYING vec4 bins_ambient; // w: shininess
layout(location = 6) flat VARYING vec4 bins_albedo;  // w: strength of the highlight
layout(location = 7) flat VARYING vec4 bins_light_0; // towards it, world axes; red of its colour
layout(location = 8) flat VARYING vec4 bins_light_1; // the same
layout(location = 9) flat VARYING vec4 bins_colors;  // green and blue of both
layout(location = 11) flat VARYING vec4 bins_bounds; // this and the next as in the batch's block
layout(location = 12) flat VARYING vec4 bins_axis;
#if READS_MAP
layout(location = 13) flat VARYING vec4 bins_map;
#endif
#if TAKES_STEPS
layout(location = 14) flat VARYING vec4 bins_offset;
#endif
#if READS_TABLES
layout(location = 15) flat VARYING uvec4 bins_patches;
#endif

#endif
