// Traces a fragment of a shape box.
#ifndef BOX_FRAGMENT_GLSL
#define BOX_FRAGMENT_GLSL
#include "box_varyings.glsl"
#include "fragment.glsl"

bool trace_box(uvec2 pixel, out Hit hit)
{
    take_over();
    solid.bounds = box_bounds;
    solid.map = box_map;
    solid.offset = box_offset;
    solid.pieces = box_pieces;
    solid.axis = box_axis;
    return trace(ray_eye.xyz, ray_direction(varying_rays(), pixel), hit);
}

#endif
