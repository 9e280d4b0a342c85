// Intersects a ray of a hull's fragment with the patches of its cell, without branches. src/surface/hull.rs defines
// cells and proves that no ray is lost; its `trace` is the CPU twin of this file.
#ifndef CELL_GLSL
#define CELL_GLSL
#extension GL_EXT_control_flow_attributes : require
#include "stage/cell_varyings.glsl"
#include "core/hit.glsl"
#include "search/quadric.glsl"

// No ray may be in the solid before it is between `hull_sides`.
bool trace_hull(uvec2 pixel, out Hit hit)
{
    take_over();
    PixelRays rays = varying_rays();
    Meridian m; // s = 0 is in the plane at depth `base`
    m.v = ray_direction(rays, pixel);
    m.o = ray_origin(rays, pixel);
    m.a = dot(m.v.xy, m.v.xy);
    m.b = dot(m.o.xy, m.v.xy);
    m.c = dot(m.o.xy, m.o.xy);
    vec2 valid = vec2(-rays.base, 2e38); // range of t of hits
    if (OUTSIDE == 0u) {
        vec2 span = between_sides(m.o, m.v, hull_sides);
        valid = vec2(max(valid.x, span.x), span.y);
    }
    float best = valid.y;
    vec4 quadric = vec4(0.0);
    [[unroll]] for (uint k = 0u; k < PATCHES_PER_CELL; ++k) {
        take_nearer(m, hull_quadric[k], hull_guard[k], valid.x, best, quadric);
    }
    hit.t = best;
    hit.normal = quadric_normal(m, best, quadric);
    hit.point = m.o + best * m.v;
    hit.sense = vec3(1.0);
    hit.steps = PATCHES_PER_CELL;
    hit.exhausted = false;
    hit.at_border = false;
    return best < valid.y;
}

#endif
