// Tiles: squares of GROUP_PIXELS^2 pixels with the copies that may be visible there. One buffer has three ranges, each of
// one structure (structures.glsl): first blocks of queues, then tiles, then gathered pixels. Indices count from the
// buffer's start in units of the structure. The first block is zero.
#ifndef TILES_GLSL
#define TILES_GLSL
#include "core/structures.glsl"

layout(set = 2, binding = 1, std430) readonly buffer QueueBlocks {
    QueueBlock queue_blocks[];
};
layout(set = 2, binding = 1, std430) readonly buffer CopyTiles {
    CopyTile copy_tiles[];
};
layout(set = 2, binding = 1, std430) readonly buffer QueueTiles {
    QueueTile queue_tiles[];
};
layout(set = 2, binding = 1, std430) readonly buffer GatheredPixels {
    GatheredPixel gathered_pixels[];
};

// Returns the upper left pixel of a tile with a queue.
uvec2 corner_of(QueueTile tile)
{
    return GROUP_PIXELS * (uvec2(tile.place, tile.place >> TILE_BITS) & ((1u << TILE_BITS) - 1u));
}

// Returns the upper left pixel of a square.
uvec2 square_corner(uint square)
{
    return uvec2(square, square >> QUAD_BITS) & ((1u << QUAD_BITS) - 1u);
}

// Returns the number of a pixel in its tile.
uint bit_of(uvec2 pixel)
{
    return (pixel.x & GROUP_PIXELS - 1u) | (pixel.y & GROUP_PIXELS - 1u) * GROUP_PIXELS;
}

#endif
