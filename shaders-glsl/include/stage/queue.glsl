// Finds the nearest hit of a pixel among the copies in the queue of its tile.
#ifndef QUEUE_GLSL
#define QUEUE_GLSL
#include "stage/tile_words.glsl"
#include "core/replicas.glsl"

const bool MAY_BE_OF_DEVICE = SEARCH == SEARCH_QUADRIC; // the device lists tiles of patches alone

// Returns true if pixel `bit` of the tile may show the copy at `word`.
bool is_marked(uint word, uint bit)
{
    return (tile_words[word + 2u + (bit >> 5)] >> (bit & 31u) & 1u) != 0u;
}

// Finds the nearest hit. The first of equal depths wins, as under the depth test. The loop ends when the next copy
// begins behind the hit, or behind the initial `depth`, which grows away from the eye. `bit`: number of the pixel in its
// tile; `at`: position of the ray (pixel_ray.glsl); `index`: instance that was hit. `nearest.steps` and
// `nearest.exhausted` are those of all searches, with or without a hit.
bool nearest_copy(uint first, uint count, uint bit, vec2 at, inout float depth, out uint index, out Hit nearest)
{
    bool found = false;
    uint steps = 0u;
    bool exhausted = false;
    // An unsorted queue holds all visible copies, of all layers.
    bool sorted = !MAY_BE_OF_DEVICE || (count & QUEUE_UNSORTED) == 0u;
    uint layer = count >> QUEUE_LAYER_SHIFT & 127u;
    uint end = first + QUEUE_WORDS * (MAY_BE_OF_DEVICE ? count & QUEUE_COUNT : count);
    float sense = frame.forward.w;
    for (uint word = first; word < end; word += QUEUE_WORDS) {
        // Invocations meet behind this loop, each with the next copy of its own pixel.
        while (word < end && !is_marked(word, bit)) {
            word += QUEUE_WORDS;
        }
        if (word >= end) {
            break;
        }
        float begins = uintBitsToFloat(tile_words[word + 1u]);
        if (sense * depth_of(max(begins, 1e-30)) >= depth) {
            if (sorted) {
                break;
            }
            continue;
        }
        uint number = tile_words[word];
        Instance i = instances[number];
        if (!sorted && i.object.y != layer) {
            continue;
        }
        if (ONE_OBJECT == 0u) {
            take_shape(i.object.x);
        }
        PixelRays rays = pixel_rays(i);
        Hit hit;
        bool met = trace(ray_origin(rays, at), ray_direction(rays, at), rays.base, EVERYWHERE, hit);
        steps += hit.steps;
        exhausted = exhausted || hit.exhausted;
        float met_at = sense * depth_of(rays.base + hit.t);
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

#endif
