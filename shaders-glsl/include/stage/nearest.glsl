// The nearest hit of a pixel in compute, and its depth test.
#ifndef NEAREST_GLSL
#define NEAREST_GLSL
#include "stage/pixel_words.glsl"
#include "core/hit.glsl"

struct Nearest {
    Hit hit;
    uint instance;
    float depth;
    uint steps; // total of all searches
    bool exhausted; // true if a search ran out of steps
};

// Returns the depth limit: a hit must be nearer.
float drawn_depth(uvec2 pixel)
{
    return DEPTH_TEST != 0u ? uintBitsToFloat(pixel_words[depth_word(pixel)]) : 1.0;
}

void keep_depth(uvec2 pixel, Nearest nearest)
{
    if (DEPTH_KEEP != 0u) {
        pixel_words[depth_word(pixel)] = floatBitsToUint(nearest.depth);
    }
}

#endif
