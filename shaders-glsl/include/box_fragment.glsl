// Traces a fragment of a shape box, or of a convex hull.
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
    // Of a convex hull, whose fragments are where rays enter it. Roundings grow with t, and so does what they are allowed.
    vec2 span = AHEAD != 0u ? vec2((1.0 - 1e-4) / gl_FragCoord.w, EVERYWHERE.y) : EVERYWHERE;
    return trace(ray_eye.xyz, ray_direction(varying_rays(), pixel), span, hit);
}

#endif
