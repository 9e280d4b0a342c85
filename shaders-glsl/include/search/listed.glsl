// Intersects a pixel's ray with the listed patches of its tile, without branches. The invocations of a group share the
// loads of instance and patches, because lavapipe 22 reads storage buffers lane by lane. Each loads the tile: another
// barrier costs lavapipe 25 an eighth of the time.
#ifndef LISTED_GLSL
#define LISTED_GLSL
#extension GL_EXT_control_flow_attributes : require
#include "stage/shared_object.glsl"
#include "search/patch_row.glsl"

shared float listed[8u * LONGEST_LIST];

// Loads the tile's patches into shared memory.
void share_patches()
{
    uint self = gl_LocalInvocationIndex;
    shape.listed = instances[tile.instance].listed - (OWN_TABLES ? shape.listed_window : 0u);
    uint none = listed_word(0u, 0u);
    uint runs = tile.found.x;
    [[unroll]] for (uint j = 0u; j < 8u * LIST_LENGTH; j += GROUP_PIXELS * GROUP_PIXELS) {
        uint at = j + self;
        if (at < 8u * LIST_LENGTH) {
            uint number = at >> 3;
            uint lower = runs >> 9 & 63u;
            uint k = number < lower ? (runs & 511u) + number : (runs >> 15 & 511u) + number - lower;
            k = number < lower + (runs >> 24 & 63u) ? k : none;
            listed[at] = uintBitsToFloat(listed_word(1u + 3u * k + (at >> 2 & 1u), at & 3u));
        }
    }
}

vec4 listed_vector(uint n)
{
    return vec4(listed[4u * n], listed[4u * n + 1u], listed[4u * n + 2u], listed[4u * n + 3u]);
}

bool search_listed(uvec2 pixel, out Hit hit)
{
    vec2 at = vec2(pixel);
    // The ray's s = 0 is near the middle, or at the height of a tip.
    vec3 weights = mix(weights_of_middle(), vec3(0.0, 0.0, 1.0), bvec3((tile.found.x >> 31) != 0u));
    float height = uintBitsToFloat(tile.found.y);
    float shift = nearest_to(ray_origin(tile_rays, at), ray_direction(tile_rays, at), height, weights);
    PatchRow row = begin_row(tile_rays, at, shift);
    // The lists contain no tile with a ray that is in the solid before it enters the box: see tile_lists.comp.
    if (!is_outside()) {
        clip_to_sides(row);
    }
    [[unroll]] for (uint k = 0u; k < LIST_LENGTH; ++k) {
        take_nearer(row.m, listed_vector(2u * k), listed_vector(2u * k + 1u), row.least, row.best, row.quadric);
    }
    return end_row(row, LIST_LENGTH, hit);
}

#endif
