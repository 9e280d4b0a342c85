// The nearest hit of a pixel of compute, and what is done with it.
#ifndef NEAREST_GLSL
#define NEAREST_GLSL
#include "stage/pixel_words.glsl"
#include "core/hit.glsl"

struct Nearest {
    Hit hit;
    uint instance;
    float depth;
    uint steps; // of all searches
    bool exhausted; // one of them ran out of steps
};

// The depth that a hit must be nearer than.
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
