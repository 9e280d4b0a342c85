// Inputs of every dispatch: push constants and bins of tiles.
#ifndef COMPUTE_GLSL
#define COMPUTE_GLSL
#include "stage/tiles.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

layout(push_constant) uniform PushedBlock {
    Pushed pushed;
};

// Bins of tiles by the length of their lists of patches, filled by tile_lists.comp from N tiles: TILE_BINS heads, each an
// indirect dispatch with one work group per tile in the bin, then N tiles per bin. Tiles of the last bin use the tree.
#ifndef BIN_ACCESS
#define BIN_ACCESS readonly
#endif
layout(set = 2, binding = 6, std430) BIN_ACCESS buffer BinHeads {
    uvec4 bin_heads[]; // work groups; 1; 1; unused
};
layout(set = 2, binding = 6, std430) BIN_ACCESS buffer BinTiles {
    BinTile bin_tiles[];
};

// Returns the index of the first tile of bin `k`.
uint bin_start(uint k)
{
    return pushed.tiles + k * pushed.count;
}

#endif
