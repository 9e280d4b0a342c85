// A **tile** is a square of pixels with the copies that may be visible there. Records of four words come first, then
// queues of copies.
//
// Fragment shaders draw quads of 1, 2, 4 or 8 pixels a side, each with a single copy. A record holds corner and log2 of
// the side (x | y << QUAD_BITS | log2 << 2 QUAD_BITS, pixels), the instance's index, 0, the nearest depth (float bits).
//
// Compute shaders use tiles of GROUP_PIXELS^2. Record of a single copy: the corner (x | y << 16, pixels), the
// instance's index, 0, the nearest depth (float bits). Record of several copies: the corner, the first word of the
// tile's queue, the number of copies, the nearest depth (float bits). A queue is sorted by depth and has two words per
// copy: the instance's index, the copy's nearest depth (float bits). If the number of copies is TILE_SPLIT, the record
// is GROUP_PIXELS^2 pixels from anywhere, so that no invocation is spent on empty pixels. Each of these has three
// words: its position (x | y << 16), the start of its queue relative to the record's first such word, and its number of
// copies. Unused positions at the end are 0xffffffff, outside of any picture.
#ifndef TILE_WORDS_GLSL
#define TILE_WORDS_GLSL
#include "core/variant.glsl"

#ifndef TILE_ACCESS
#define TILE_ACCESS readonly
#endif
layout(set = 2, binding = 1, std430) TILE_ACCESS buffer TileWords {
    uint tile_words[];
};

// Returns the number of a pixel in its tile.
uint bit_of(uvec2 pixel)
{
    return (pixel.x & GROUP_PIXELS - 1u) | (pixel.y & GROUP_PIXELS - 1u) * GROUP_PIXELS;
}

#endif
