// A pixel of a tile whose patches are listed: these alone, in a straight line.
#ifndef LISTED_GLSL
#define LISTED_GLSL
#extension GL_EXT_control_flow_attributes : require
#include "stage/tile.glsl"
#include "search/quadric.glsl"

shared float listed[8u * LONGEST_LIST];

// Shares the tile's patches.
void share_patches()
{
    uint self = gl_LocalInvocationIndex;
    if (ONE_SOLID != 0u) {
        solid.hull.z = own_solid.hull.z;
    } else {
        solid.hull.z = solids[instance_words[INSTANCE_WORDS * tile_record[1] + 16u]].solid.hull.z;
    }
    uint none = listed_word(0u, 0u);
    uint runs = tile_record[2];
    [[unroll]] for (uint j = 0u; j < 8u * LIST_LENGTH; j += GROUP_PIXELS * GROUP_PIXELS) {
        uint place = j + self;
        if (place < 8u * LIST_LENGTH) {
            uint number = place >> 3;
            uint lower = runs >> 9 & 63u;
            uint k = number < lower ? (runs & 511u) + number : (runs >> 15 & 511u) + number - lower;
            k = number < lower + (runs >> 24) ? k : none;
            listed[place] = uintBitsToFloat(listed_word(1u + 3u * k + (place >> 2 & 1u), place & 3u));
        }
    }
}

vec4 listed_vector(uint n)
{
    return vec4(listed[4u * n], listed[4u * n + 1u], listed[4u * n + 2u], listed[4u * n + 3u]);
}

bool search_listed(uvec2 pixel, out Nearest nearest)
{
    vec3 v = ray_direction(tile_rays, pixel);
    Meridian m;
    m.v = v;
    m.o = ray_origin(tile_rays, pixel);
    m.a = dot(v.xy, v.xy);
    m.b = dot(m.o.xy, v.xy);
    m.c = dot(m.o.xy, m.o.xy);
    float least = -tile_rays.base;
    float most = 2e38;
    if (OUTSIDE == 0u) {
        // No ray of the tile was in the solid before the sides: see tile_lists.comp.
        vec2 span = between_sides(m.o, v, sides_of_box());
        least = max(least, span.x);
        most = span.y;
    }
    float best = most;
    vec4 quadric = vec4(0.0);
    [[unroll]] for (uint k = 0u; k < LIST_LENGTH; ++k) {
        take_nearer(m, listed_vector(2u * k), listed_vector(2u * k + 1u), least, best, quadric);
    }
    nearest.hit.t = best;
    nearest.hit.normal = quadric_normal(m, best, quadric);
    nearest.hit.point = m.o + best * v;
    nearest.hit.sense = vec3(1.0);
    nearest.hit.steps = LIST_LENGTH;
    nearest.hit.exhausted = false;
    nearest.hit.at_border = false;
    nearest.instance = 0u;
    nearest.steps = LIST_LENGTH;
    nearest.exhausted = false;
    nearest.depth = depth_of(tile_rays.base + best);
    return best < most;
}

#endif
