#version 450
#extension GL_GOOGLE_include_directive : require
// Lists the first copies of a hierarchy that the rays of each tile of a rectangle may meet, an invocation a tile.
#define BIN_ACCESS
#define MAKES_LISTS
#include "stage/walk_lists.glsl"

void main()
{
    load_frame(0u);
    load_grid();
    uvec2 corner;
    bool present = tile_of_block(corner);
    TileWalk tile = walk_of_tile(pushed.root, corner);
    if (present && !is_empty(tile)) {
        append_walk(pushed.heads, pushed.tiles, corner, tile);
    }
}
