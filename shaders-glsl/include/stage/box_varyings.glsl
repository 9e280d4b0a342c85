// Of a shape box, besides: what clipping and searching ask in every fragment.
#ifndef BOX_VARYINGS_GLSL
#define BOX_VARYINGS_GLSL
#include "stage/varyings.glsl"

layout(location = 11) flat VARYING vec4 box_bounds;
layout(location = 12) flat VARYING vec4 box_axis; // of DISPATCH_BEAMS x and y are the first and the last t
#if READS_MAP
layout(location = 13) flat VARYING vec4 box_map;
#endif
#if TAKES_STEPS
layout(location = 14) flat VARYING vec4 box_offset;
#endif
#if READS_TABLES
layout(location = 15) flat VARYING uvec4 box_patches;
#endif

#ifdef VERTEX_GLSL
void hand_over_box()
{
    box_bounds = solid.bounds;
    box_axis = solid.axis;
#if READS_MAP
    box_map = solid.map;
#endif
#if TAKES_STEPS
    box_offset = solid.offset;
#endif
#if READS_TABLES
    box_patches = solid.patches;
#endif
}
#else
void take_over_box()
{
    solid.bounds = box_bounds;
#if DISPATCH == DISPATCH_BEAMS
    solid.axis.zw = box_axis.zw;
#else
    solid.axis = box_axis;
#endif
#if READS_MAP
    solid.map = box_map;
#endif
#if TAKES_STEPS
    solid.offset = box_offset;
#endif
#if READS_TABLES
    solid.patches = box_patches;
#endif
}
#endif

#endif
