#version 450
#extension GL_GOOGLE_include_directive : require
// Lists the first copies of a hierarchy that the rays of each tile of the picture may meet, an invocation a tile.
#define BIN_ACCESS
#include "stage/tile_walk.glsl"
#include "stage/walk_lists.glsl"

void main()
{
    load_frame(0u);
    load_grid();
    uint number = pushed.first + gl_WorkGroupID.x * GROUP_PIXELS * GROUP_PIXELS + gl_LocalInvocationIndex;
    if (number < pushed.bin) {
        uvec2 corner = GROUP_PIXELS * uvec2(number % pushed.count, number / pushed.count);
        TileWalk tile = walk_of_tile(pushed.heads, corner);
        if (is_empty(tile)) {
            return;
        }
        uint index = atomicAdd(bin_heads[pushed.gathered].x, 1u);
        if (index == 0u) {
            bin_heads[pushed.gathered].yz = uvec2(1u);
        }
        uint at = pushed.tiles + TILE_WALK_VECTORS * index;
        tile_walks[at] = tile.first;
        tile_walks[at + 1u] = uvec4(tile.node, tile.trail, floatBitsToUint(tile.rest), number);
    }
}
