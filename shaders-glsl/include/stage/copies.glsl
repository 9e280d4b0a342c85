// The nearest hit of a pixel among the copies that its tile lists.
#ifndef COPIES_GLSL
#define COPIES_GLSL
#include "stage/compute.glsl"
#include "stage/stores.glsl"
#include "core/replicas.glsl"

// What a search reads of a solid.
void take_shape(uint number)
{
    solid.map = solids[number].solid.map;
    solid.bounds = solids[number].solid.bounds;
    solid.offset = solids[number].solid.offset;
    solid.axis = solids[number].solid.axis;
    solid.cells = solids[number].solid.cells;
    solid.patches = solids[number].solid.patches;
}

// Of equal depths the first stays, as under the depth test. Ends where the next copy begins behind the hit, or behind
// the depth that `nearest` comes with.
bool nearest_copy(uint first, uint count, uvec2 pixel, inout Nearest nearest)
{
    bool found = false;
    for (uint n = 0u; n < count; ++n) {
        float begins = uintBitsToFloat(tile_words[first + 2u * n + 1u]);
        if (depth_of(max(begins, 1e-30)) >= nearest.depth) {
            break;
        }
        uint index = tile_words[first + 2u * n];
        Instance i = instances[index];
        if (ONE_SOLID == 0u) {
            take_shape(i.solid.x);
        }
        PixelRays rays = pixel_rays(i);
        Hit hit;
        bool met = trace(ray_origin(rays, pixel), ray_direction(rays, pixel), rays.base, EVERYWHERE, hit);
        nearest.steps += hit.steps;
        nearest.exhausted = nearest.exhausted || hit.exhausted;
        float depth = depth_of(rays.base + hit.t);
        if (met && depth < nearest.depth) {
            found = true;
            nearest.depth = depth;
            nearest.hit = hit;
            nearest.instance = index;
        }
    }
    return found;
}

// The pixel of this invocation, where its list begins and how many copies it holds.
uvec2 this_pixel(out uint first, out uint count)
{
    uint at = 4u * (pushed.first + gl_WorkGroupID.x);
    uint place = tile_words[at] + (gl_LocalInvocationID.x | gl_LocalInvocationID.y << 16);
    first = tile_words[at + 1u];
    count = tile_words[at + 2u];
    if (count == TILE_SPLIT) {
        at = first + 3u * gl_LocalInvocationIndex;
        place = tile_words[at];
        first += tile_words[at + 1u];
        count = tile_words[at + 2u];
    }
    return uvec2(place & 0xffffu, place >> 16);
}

#endif
