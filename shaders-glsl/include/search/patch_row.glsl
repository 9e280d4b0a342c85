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
    bool entered; // the ray enters a patch before `least`
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
    row.entered = false;
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

const float HEIGHT_SLACK = 1e-3; // outside the box's height another sheet of a quadric may satisfy the guard

// Replaces the nearest hit so far by the hit with patch `q`, if that is nearer.
void take_nearer(inout PatchRow row, vec4 q, vec4 guard)
{
    float above = row.m.o.z - guard.x;
    float root = entering_root(row.m, q, above, 1.0);
    float z = row.m.o.z + root * row.m.v.z;
    float guarded = abs(q.x) * (above + root * row.m.v.z) + guard.y * square_at(row.m, root);
    bool within = all(lessThanEqual(vec3(guard.z, guarded, abs(z - 0.5)), vec3(guarded, guard.w, 0.5 + HEIGHT_SLACK)));
    bool nearer = within && root > row.least && root < row.best;
    row.entered = row.entered || within && root <= row.least;
    row.best = mix(row.best, root, nearer);
    row.quadric = mix(row.quadric, vec4(q.x, guard.x, q.zw), bvec4(nearer));
}

// Returns true if one of `count` patches was hit.
bool end_row(PatchRow row, uint count, out Hit hit)
{
    hit.t = row.best;
    hit.normal = quadric_normal(row.m, row.best, row.quadric);
    hit.point = row.m.o + row.best * row.m.v;
    hit.sense = vec3(1.0);
    hit.steps = count;
    hit.exhausted = false;
    hit.at_border = false;
    return row.best < row.most;
}

#endif
