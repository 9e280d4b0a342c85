// A pixel's ray and its nearest hit so far, for the few patches of a cell or of a tile, in sequence without branches.
#ifndef PATCH_ROW_GLSL
#define PATCH_ROW_GLSL
#include "core/hit.glsl"
#include "core/pixel_ray.glsl"
#include "search/quadric.glsl"

struct PatchRow {
    // s = 0 is near the hit or the axis: 32 bits hold boxes of any ratio there, and tips.
    Meridian m;
    float shift; // t = shift + s
    float least, most; // range of s of valid hits
    float best;
    vec4 quadric; // patch of the nearest hit so far
};

// Returns the `t` at which a ray is nearest to the axis, in a flat or wide box nearest to its middle.
float middle_of(PixelRays rays, vec2 pixel)
{
    return nearest_to(ray_origin(rays, pixel), ray_direction(rays, pixel), 0.5, weights_of_middle());
}

// `shift`: the `t` of s = 0.
PatchRow begin_row(PixelRays rays, vec2 pixel, float shift)
{
    PatchRow row;
    row.m.v = ray_direction(rays, pixel);
    row.shift = shift;
    row.m.o = ray_origin(rays, pixel) + shift * row.m.v;
    row.m.a = dot(row.m.v.xy, row.m.v.xy);
    row.m.b = dot(row.m.o.xy, row.m.v.xy);
    row.m.c = dot(row.m.o.xy, row.m.o.xy);
    row.least = -rays.base - shift;
    row.most = 2e38;
    row.best = row.most;
    row.quadric = vec4(0.0);
    return row;
}

// Limits hits to the part of the ray between the box's sides.
void clip_to_sides(inout PatchRow row)
{
    vec2 span = between_sides(row.m.o, row.m.v, sides_of_box());
    row.least = max(row.least, span.x);
    row.most = span.y;
    row.best = span.y;
}

// Returns true if one of `count` patches was hit.
bool end_row(PatchRow row, uint count, out Hit hit)
{
    hit = NO_HIT;
    hit.t = row.shift + row.best;
    hit.normal = quadric_normal(row.m, row.best, row.quadric);
    hit.point = row.m.o + row.best * row.m.v;
    hit.steps = count;
    return row.best < row.most;
}

#endif
