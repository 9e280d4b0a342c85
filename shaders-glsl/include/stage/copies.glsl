// Finds the nearest hit of a pixel among the copies in the queue of its tile.
#ifndef COPIES_GLSL
#define COPIES_GLSL
#include "stage/stores.glsl"

// Finds the nearest hit. The first of equal depths wins, as under the depth test. The loop ends when the next copy
// begins behind the hit, or behind the initial `depth`. `index`: instance that was hit. `nearest.steps` and
// `nearest.exhausted` are those of all searches, with or without a hit.
bool nearest_copy(uint first, uint count, uvec2 pixel, inout float depth, out uint index, out Hit nearest)
{
    bool found = false;
    uint steps = 0u;
    bool exhausted = false;
    for (uint n = 0u; n < count; ++n) {
        float begins = uintBitsToFloat(tile_words[first + 2u * n + 1u]);
        if (depth_of(max(begins, 1e-30)) >= depth) {
            break;
        }
        uint number = tile_words[first + 2u * n];
        Instance i = instances[number];
        if (ONE_OBJECT == 0u) {
            take_shape(i.object.x);
        }
        PixelRays rays = pixel_rays(i);
        Hit hit;
        bool met = trace(ray_origin(rays, pixel), ray_direction(rays, pixel), rays.base, EVERYWHERE, hit);
        steps += hit.steps;
        exhausted = exhausted || hit.exhausted;
        float met_at = depth_of(rays.base + hit.t);
        if (met && met_at < depth) {
            found = true;
            depth = met_at;
            nearest = hit;
            index = number;
        }
    }
    nearest.steps = steps;
    nearest.exhausted = exhausted;
    return found;
}

// Returns the pixel of this invocation, the first word of its queue and the number of copies in it.
uvec2 this_pixel(out uint first, out uint count)
{
    uint at = 4u * (pushed.first + gl_WorkGroupID.x);
    uint position = tile_words[at] + (gl_LocalInvocationID.x | gl_LocalInvocationID.y << 16);
    first = tile_words[at + 1u];
    count = tile_words[at + 2u];
    if (count == TILE_SPLIT) {
        at = first + 3u * gl_LocalInvocationIndex;
        position = tile_words[at];
        first += tile_words[at + 1u];
        count = tile_words[at + 2u];
    }
    return uvec2(position & 0xffffu, position >> 16);
}

#endif
