// The walks of tiles that walk_lists.comp and tile_lists.comp make: TILE_WALK_VECTORS vectors for each tile that may show
// a copy, in any order. A head holds their number, as a dispatch with a work group for each.
#ifndef WALK_LISTS_GLSL
#define WALK_LISTS_GLSL
#include "stage/compute.glsl"
#include "stage/tile_walk.glsl"

layout(set = 2, binding = 6, std430) BIN_ACCESS buffer TileWalks {
    uvec4 tile_walks[];
};

#ifdef MAKES_LISTS
// Returns true if the invocation has a tile of the rectangle, and its corner. A work group has a block of tiles, as many
// across and down as it has invocations.
bool tile_of_block(out uvec2 corner)
{
    uvec2 size = squares_of_rectangle();
    uint across = (size.x + GROUP_PIXELS - 1u) / GROUP_PIXELS;
    uint block = pushed.first + gl_WorkGroupID.x;
    uvec2 tile = GROUP_PIXELS * uvec2(block % across, block / across) + gl_LocalInvocationID.xy;
    corner = square_corner(pushed.corner) + GROUP_PIXELS * tile;
    return all(lessThan(tile, size));
}

// Counts a tile in a head, and returns its number there. Heads are zero at first; the first tile completes the indirect
// dispatch.
uint count_tile(uint head)
{
    uint number = atomicAdd(bin_heads[head].x, 1u);
    if (number == 0u) {
        bin_heads[head].yz = uvec2(1u);
    }
    return number;
}

// Adds the walk of a tile. `head`: that of walks; `first`: their first vector.
void append_walk(uint head, uint first, uvec2 corner, TileWalk tile)
{
    uint at = first + TILE_WALK_VECTORS * count_tile(head);
    tile_walks[at] = tile.first;
    tile_walks[at + 1u] = uvec4(tile.node, tile.trail, floatBitsToUint(tile.rest), square_of(corner));
}
#endif

#endif
