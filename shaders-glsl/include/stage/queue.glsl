// Finds the nearest hit of a pixel among the copies in the queue of its tile.
#ifndef QUEUE_GLSL
#define QUEUE_GLSL
#include "stage/tile_words.glsl"
#include "core/replicas.glsl"

// Returns a depth in the unit of nearest_copy. Fragments read no depths of a buffer, so theirs are in clip space. They
// exceed its limits before the near plane and beyond the far plane. Rays are never parallel.
float queue_depth_of(float t)
{
#ifdef CLIP_DEPTHS
    return frame.dir_x.w + frame.dir_y.w / t;
#else
    return depth_of(t);
#endif
}

// Returns the copies of a block of a queue that pixel `bit` of the tile may show, one bit each.
uint marks_of(uint block, uint bit)
{
    uint at = bit * QUEUE_BLOCK;
    return bitfieldExtract(tile_words[block + 2u * QUEUE_BLOCK + (at >> 5)], int(at & 31u), int(QUEUE_BLOCK));
}

// Finds the nearest hit. Of equal depths, the copy that begins nearer wins, then the first one, as under a depth test of
// sorted copies. Copies that begin behind the hit, or behind the initial `depth`, which grows away from the eye, are
// left out. `bit`: number of the pixel in its tile; `at`: position of the ray (pixel_ray.glsl); `index`: instance that
// was hit. `nearest.steps` and `nearest.exhausted` are those of all searches, with or without a hit.
bool nearest_copy(uint first, uint count, uint bit, vec2 at, inout float depth, out uint index, out Hit nearest)
{
    bool found = false;
    uint steps = 0u;
    bool exhausted = false;
    uint end = first + QUEUE_WORDS * count;
    float sense = frame.forward.w;
    uint nearest_word = first; // of the copy that was hit
    uint block = first;        // the next one
    uint marks = 0u;
    for (;;) {
        // Invocations meet behind this loop, each with the next copy of its own pixel.
        while (marks == 0u && block < end) {
            marks = marks_of(block, bit);
            block += QUEUE_WORDS * QUEUE_BLOCK;
        }
        if (marks == 0u) {
            break;
        }
        uint word = block - QUEUE_WORDS * QUEUE_BLOCK + 2u * uint(findLSB(marks));
        marks &= marks - 1u;
        if (sense * queue_depth_of(max(uintBitsToFloat(tile_words[word + 1u]), 1e-30)) >= depth) {
            break;
        }
        Instance i = instances[tile_words[word]];
        take_shape(i);
        PixelRays rays = pixel_rays(i);
        Hit hit;
        bool met = trace(ray_origin(rays, at), ray_direction(rays, at), rays.base, EVERYWHERE, hit);
        steps += hit.steps;
        exhausted = exhausted || hit.exhausted;
        float met_at = sense * queue_depth_of(rays.base + hit.t);
        if (met && met_at < depth) {
            found = true;
            nearest_word = word;
            depth = met_at;
            nearest = hit;
        }
    }
    index = tile_words[nearest_word];
    nearest.steps = steps;
    nearest.exhausted = exhausted;
    return found;
}

#endif
