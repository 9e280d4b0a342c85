// A **beam** bounds the rays of a square of pixels: the middle ray and the largest deviation from it.
#ifndef BEAM_GLSL
#define BEAM_GLSL
#include "core/patch_tables.glsl"
#include "core/pixel_ray.glsl"

const uint SPAN_NODES = 16u; // nodes of the tree's second level from the top
const uint SPAN_FIRST = 320u; // index of its first node

struct Beam {
    vec3 o;
    vec3 v;
    float least, nearest, a; // r^2 of the middle ray: least + a (t - nearest)^2
    float per_z;
    float width; // largest distance of a ray from the middle one at equal t, anywhere in the box
};

// Returns the depth of the far side of the box.
float farthest_of(PixelRays rays, Instance i)
{
    vec3 half_size = vec3(solid.bounds.x, solid.bounds.x, 0.5);
    vec3 forward = rotate(conjugate(i.rotation), frame.forward.xyz) * scale_of(i);
    return rays.base + dot(abs(forward), half_size);
}

// Returns the beam of a square of pixels.
Beam beam_of(PixelRays rays, uvec2 corner, uint side, float farthest)
{
    Beam beam;
    float half_side = 0.5 * float(side);
    vec2 middle = vec2(corner) + half_side - 0.5;
    beam.v = rays.dir_00 + middle.x * rays.dir_x + middle.y * rays.dir_y;
    beam.o = rays.origin + rays.base * (middle.x * rays.dir_x + middle.y * rays.dir_y);
    float spread = half_side * max(length(rays.dir_x + rays.dir_y), length(rays.dir_x - rays.dir_y));
    beam.width = spread * farthest + 1e-4;
    beam.a = max(dot(beam.v.xy, beam.v.xy), 1e-12 * dot(beam.v, beam.v));
    // This divides, as node_span() does: rounding of 1 / a loses pixels of a plate that is a thousand times as wide as
    // high.
    beam.nearest = -dot(beam.o.xy, beam.v.xy) / beam.a;
    beam.least = max(dot(beam.o.xy, beam.o.xy) - beam.a * beam.nearest * beam.nearest, 0.0);
    beam.per_z = 1.0 / (abs(beam.v.z) > 1e-20 ? beam.v.z : 1e-20);
    return beam;
}

// Returns the range of t in which a beam may hit node `k`; the range is empty (x > y) if it cannot.
vec2 node_span(Beam beam, uint k)
{
    // Storage buffer only: lavapipe 22 treats uniforms that branches depend on as constants, and crashes.
    uint at = SPAN_FIRST + k;
    float most = node_extent(patch_tables[solid.patches.x + (at >> 2)][at & 3u]).y;
    float radius = sqrt(max(most, 0.0)) + beam.width;
    float low = (float(k) / float(SPAN_NODES) - beam.width - beam.o.z) * beam.per_z;
    float high = (float(k + 1u) / float(SPAN_NODES) + beam.width - beam.o.z) * beam.per_z;
    float reach = sqrt(max(radius * radius - beam.least, 0.0) / beam.a);
    vec2 span = vec2(max(min(low, high), beam.nearest - reach), min(max(low, high), beam.nearest + reach));
    bool meets = most > 0.0 && radius * radius > beam.least && span.x <= span.y;
    return meets ? span : vec2(3e38, -3e38);
}

// Returns the range of t in which a beam may hit the solid, from the largest radii of the nodes.
vec2 beam_span(Beam beam)
{
    vec2 span = vec2(3e38, -3e38);
    for (uint k = 0u; k < SPAN_NODES; ++k) {
        vec2 met = node_span(beam, k);
        span = vec2(min(span.x, met.x), max(span.y, met.y));
    }
    return span;
}

#endif
