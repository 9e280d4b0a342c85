// Of a shape box, besides: what clipping and searching ask in every fragment.
#ifndef BOX_VARYINGS_GLSL
#define BOX_VARYINGS_GLSL
#include "varyings.glsl"

layout(location = 11) flat VARYING vec4 box_bounds;
layout(location = 12) flat VARYING vec4 box_map;
layout(location = 13) flat VARYING vec4 box_offset;
layout(location = 14) flat VARYING uvec4 box_pieces;
layout(location = 15) flat VARYING vec4 box_axis;

#ifdef VERTEX_GLSL
void hand_over_box()
{
    box_bounds = solid.bounds;
    box_map = solid.map;
    box_offset = solid.offset;
    box_pieces = solid.pieces;
    box_axis = solid.axis;
}
#endif

#endif
