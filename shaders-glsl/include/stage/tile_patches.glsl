// A pixel of a tile whose patches are listed: these alone, in a straight line.
#ifndef TILE_PATCHES_GLSL
#define TILE_PATCHES_GLSL
#extension GL_EXT_control_flow_attributes : require
#include "stage/patch_lists.glsl"
#include "stage/bins.glsl"

// Where places are constants software drivers read shared memory once for all lanes.
shared float listed[8u * LONGEST_LIST];
shared uint listed_tile;

// Copies the patches of this group's tile; returns the tile.
uvec2 take_list()
{
    uint self = gl_LocalInvocationIndex;
    uint at = list_tiles(pushed.list) + 2u * gl_WorkGroupID.x;
    uint none = own_patch_tables[0].x;
    if (self == 0u) {
        listed_tile = bin_words[at];
    }
    [[unroll]] for (uint j = 0u; j < 8u * LIST_LENGTH; j += GROUP_PIXELS * GROUP_PIXELS) {
        uint place = j + self;
        if (place < 8u * LIST_LENGTH) {
            uint runs = bin_words[at + 1u];
            uint number = place >> 3;
            uint lower = runs >> 9 & 63u;
            uint k = number < lower ? (runs & 511u) + number : (runs >> 15 & 511u) + number - lower;
            k = number < lower + (runs >> 24) ? k : none;
            listed[place] = uintBitsToFloat(own_patch_tables[1u + 3u * k + (place >> 2 & 1u)][place & 3u]);
        }
    }
    barrier();
    return uvec2(listed_tile & 0xffffu, listed_tile >> 16);
}

vec4 listed_vector(uint n)
{
    return vec4(listed[4u * n], listed[4u * n + 1u], listed[4u * n + 2u], listed[4u * n + 3u]);
}

bool nearest_in_tile(uvec2 pixel, out Nearest nearest)
{
    vec3 v = ray_direction(single_rays, pixel);
    Meridian m;
    m.v = v;
    m.o = ray_origin(single_rays, pixel);
    m.a = dot(v.xy, v.xy);
    m.b = dot(m.o.xy, v.xy);
    m.c = dot(m.o.xy, m.o.xy);
    float least = -single_rays.base;
    float most = 2e38;
    if (OUTSIDE == 0u) {
        // No ray of the tile was in the solid before the sides: see list.comp.
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
    nearest.depth = depth_of(single_rays.base + best);
    return best < most;
}

#endif
