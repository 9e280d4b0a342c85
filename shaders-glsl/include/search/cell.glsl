// A fragment of a hull: the patches of its own cell, in a straight line. What a cell is, and why it loses no ray:
// src/surface/hull.rs, whose `trace` is this file's twin.
#ifndef CELL_GLSL
#define CELL_GLSL
#extension GL_EXT_control_flow_attributes : require
#include "stage/cell_varyings.glsl"
#include "stage/fragment.glsl"
#include "core/hit.glsl"
#include "search/quadric.glsl"

bool trace_hull(uvec2 pixel, out Hit hit)
{
    take_over();
    PixelRays rays = varying_rays();
    vec3 v = ray_direction(rays, pixel);
    Meridian m;
    m.v = v;
    m.o = ray_origin(rays, pixel);
    m.a = dot(v.xy, v.xy);
    m.b = dot(m.o.xy, v.xy);
    m.c = dot(m.o.xy, m.o.xy);
    float least = -rays.base;
    float most = 2e38;
    if (OUTSIDE == 0u) {
        vec2 span = between_sides(m.o, m.v, hull_sides);
        least = max(least, span.x);
        most = span.y;
    }
    float best = most;
    vec4 quadric = vec4(0.0);
    [[unroll]] for (uint k = 0u; k < PATCHES_PER_CELL; ++k) {
        take_nearer(m, hull_quadric[k], hull_guard[k], least, best, quadric);
    }
    hit.t = best;
    hit.normal = quadric_normal(m, best, quadric);
    hit.point = m.o + best * v;
    hit.sense = vec3(1.0);
    hit.steps = PATCHES_PER_CELL;
    hit.exhausted = false;
    hit.at_border = false;
    return best < most;
}

// Its own triangle is nowhere behind the surface it wraps, but for rounding.
float hull_depth(float t)
{
    float sense = ray_dir_00.w;
    return sense * max(sense * depth_of(t), sense * gl_FragCoord.z);
}

#endif
