// A **tile** is a square of GROUP_PIXELS^2 pixels with the copies that may be visible there. Records of four words come
// first, then queues of copies.
//
// Record: the tile (column | row << TILE_BITS | halves << RECORD_HALVES_SHIFT), the first word of its queue, the number
// of copies, the nearest depth (float bits). A queue is sorted by depth and has blocks of QUEUE_BLOCK copies. A block
// begins with two words per copy: the instance's index and the copy's nearest depth (float bits). Then it has
// QUEUE_BLOCK bits per pixel of the tile, one for each copy that the pixel may show. The rest of the last block is zero.
//
// Fragment shaders also draw quads of 1, 2, 4 or 8 pixels a side, each with a single copy. A record holds corner and
// log2 of the side (x | y << QUAD_BITS | log2 << 2 QUAD_BITS, pixels), the instance's index, 0, the nearest depth.
//
// Compute shaders have two more kinds of records:
// - A single copy: the corner (x | y << 16, pixels), the instance's index, 0, the nearest depth.
// - GROUP_PIXELS^2 pixels from anywhere, so that no invocation is spent on empty pixels. The number of copies is
//   TILE_SPLIT. Each pixel has three words, from the record's second word on: its position (x | y << 16), the start of
//   its tile's queue relative to the record's first such word, and the queue's number of copies. Unused positions are
//   0xffffffff, outside of any picture.
#ifndef TILE_WORDS_GLSL
#define TILE_WORDS_GLSL
#include "core/variant.glsl"

layout(set = 2, binding = 1, std430) readonly buffer TileWords {
    uint tile_words[];
};

// Returns the upper left pixel of a record's tile.
uvec2 tile_corner_of(uint packed)
{
    return GROUP_PIXELS * (uvec2(packed, packed >> TILE_BITS) & ((1u << TILE_BITS) - 1u));
}

// Returns the number of a pixel in its tile.
uint bit_of(uvec2 pixel)
{
    return (pixel.x & GROUP_PIXELS - 1u) | (pixel.y & GROUP_PIXELS - 1u) * GROUP_PIXELS;
}

#endif
