// Tiles: squares of pixels and the copies that may show there. Records of four words come first, then lists.
//
// Fragments are drawn for quads of 1, 2, 4 or 8 pixels a side, each of one copy: the corner in pixels and the side's
// logarithm (x | y << QUAD_BITS | logarithm << 2 QUAD_BITS), the instance's number, 0, the bits of its nearest depth.
//
// Compute takes tiles of GROUP_PIXELS^2. Of one copy: the corner in pixels (x | y << 16), the instance's number, 0, the
// bits of its nearest depth. Of several: the corner, the word where the tile's list begins, how many copies it holds, the
// bits of the nearest depth. A list has two words a copy, nearest first: the instance's number, the bits of the copy's
// nearest depth. With TILE_SPLIT in place of the number, the record is no square: it holds as many pixels from anywhere,
// so that no invocation is spent on pixels that show nothing. Each has three words: its place (x | y << 16), where its
// list begins, from the first of these words on, how many copies it holds. Places behind the last pixel are 0xffffffff,
// outside of every picture.
#ifndef TILE_WORDS_GLSL
#define TILE_WORDS_GLSL
#include "core/variant.glsl"

layout(set = 2, binding = 1, std430) readonly buffer TileWords {
    uint tile_words[];
};

#endif
