// Two words per pixel, in two arrays. The first holds the nearest depth so far. The second depends on the entry file: a
// packed colour, or the number of look-ups of all searches with EXHAUSTED_BIT.
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
