// The nearest hit of a pixel among the copies that its bin lists.
#ifndef LISTED_GLSL
#define LISTED_GLSL
#include "stage/bin_words.glsl"
#include "core/cells.glsl"

struct Nearest {
    Hit hit;
    uint instance;
    float depth;
    uint steps; // of all searches
    bool exhausted; // one of them ran out of steps
};

// Of equal depths the first stays, as under the depth test. Ends where the next copy begins behind the hit, or behind
// the depth that `nearest` comes with.
bool nearest_listed(uint first, uint count, uvec2 pixel, inout Nearest nearest)
{
    bool found = false;
    float sense = frame.forward.w;
    for (uint n = 0u; n < count; ++n) {
        float begins = uintBitsToFloat(bin_words[first + 2u * n + 1u]);
        if (sense * depth_of(max(begins, 1e-30)) >= sense * nearest.depth) {
            break;
        }
        uint index = bin_words[first + 2u * n];
        PixelRays rays = pixel_rays(instances[index]);
        Hit hit;
        bool met = trace(ray_origin(rays, pixel), ray_direction(rays, pixel), rays.base, EVERYWHERE, hit);
        nearest.steps += hit.steps;
        nearest.exhausted = nearest.exhausted || hit.exhausted;
        float depth = depth_of(rays.base + hit.t);
        if (met && sense * depth < sense * nearest.depth) {
            found = true;
            nearest.depth = depth;
            nearest.hit = hit;
            nearest.instance = index;
        }
    }
    return found;
}

#endif
