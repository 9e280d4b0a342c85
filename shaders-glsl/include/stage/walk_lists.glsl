// The walks of tiles that walk_lists.comp makes: TILE_WALK_VECTORS vectors for each tile that may show a copy, in any
// order. A head holds their number, as a dispatch with a work group for each.
#ifndef WALK_LISTS_GLSL
#define WALK_LISTS_GLSL
#include "stage/compute.glsl"
#include "stage/tile_walk.glsl"

layout(set = 2, binding = 6, std430) BIN_ACCESS buffer TileWalks {
    uvec4 tile_walks[];
};

#endif
