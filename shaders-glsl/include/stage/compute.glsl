// Inputs of every dispatch: push constants, rectangles of tiles, and bins of tiles. A tile is a square of GROUP_PIXELS^2
// pixels.
#ifndef COMPUTE_GLSL
#define COMPUTE_GLSL
#include "core/structures.glsl"

#ifndef GROUP_SIDE
#define GROUP_SIDE GROUP_PIXELS
#endif
layout(local_size_x = GROUP_SIDE, local_size_y = GROUP_SIDE) in;

layout(push_constant) uniform PushedBlock {
    Pushed pushed;
};

// Bins of tiles that lists are made for: TILE_BINS heads, each an indirect dispatch with a work group for each tile of the
// bin, or one head if no patches are listed. Then pushed.room tiles for each length of a list of patches, if patches are
// listed, and walks of as many tiles (walk_lists.glsl).
#ifndef BIN_ACCESS
#define BIN_ACCESS readonly
#endif
layout(set = 2, binding = 6, std430) BIN_ACCESS buffer BinHeads {
    uvec4 bin_heads[]; // work groups; 1; 1; unused
};
layout(set = 2, binding = 6, std430) BIN_ACCESS buffer BinTiles {
    BinTile bin_tiles[];
};

// Returns the pixel of 2 * QUAD_BITS bits.
uvec2 square_corner(uint square)
{
    return uvec2(square, square >> QUAD_BITS) & ((1u << QUAD_BITS) - 1u);
}

// Returns a pixel of a tile. Eight invocations that run together have 4 x 2 pixels, of which fewer are at an outline.
uvec2 pixel_of_tile(uint k)
{
    return uvec2(k & 3u | k >> 1 & 4u, k >> 2 & 1u | k >> 3 & 6u);
}

uint square_of(uvec2 corner)
{
    return corner.x | corner.y << QUAD_BITS;
}

// Returns the squares across and down the rectangle of a dispatch: tiles, or squares whose groups cull patches.
uvec2 squares_of_rectangle()
{
    return uvec2(pushed.size & 0xffffu, pushed.size >> 16);
}

#endif
