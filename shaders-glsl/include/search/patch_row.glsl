// Intersects a pixel's ray with a few patches in sequence, without branches: those of a cell or of a tile's list.
#ifndef PATCH_ROW_GLSL
#define PATCH_ROW_GLSL
#include "core/hit.glsl"
#include "core/pixel_ray.glsl"
#include "search/quadric.glsl"

struct PatchRow {
    Meridian m; // s = 0 is in the plane at depth `base`
    float least, most; // range of t of valid hits
    float best;
    vec4 quadric; // patch of the nearest hit so far
};

PatchRow begin_row(PixelRays rays, vec2 pixel)
{
    PatchRow row;
    row.m.v = ray_direction(rays, pixel);
    row.m.o = ray_origin(rays, pixel);
    row.m.a = dot(row.m.v.xy, row.m.v.xy);
    row.m.b = dot(row.m.o.xy, row.m.v.xy);
    row.m.c = dot(row.m.o.xy, row.m.o.xy);
    row.least = -rays.base;
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
    hit.t = row.best;
    hit.normal = quadric_normal(row.m, row.best, row.quadric);
    hit.point = row.m.o + row.best * row.m.v;
    hit.steps = count;
    return row.best < row.most;
}

#endif
