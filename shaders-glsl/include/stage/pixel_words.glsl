// Two words a pixel, in two runs: the nearest depth so far, then what the entry file keeps there (a packed colour, or
// the look-ups of all searches in that pixel, with a bit that tells whether one of them ran out of steps).
#ifndef PIXEL_WORDS_GLSL
#define PIXEL_WORDS_GLSL
#include "core/blocks.glsl"

layout(set = 2, binding = 0, std430) buffer PixelWords {
    uint pixel_words[];
};

uint depth_word(uvec2 pixel)
{
    return pixel.y * frame.size.x + pixel.x;
}

uint second_word(uvec2 pixel)
{
    return (frame.size.y + pixel.y) * frame.size.x + pixel.x;
}

#endif
