// What every dispatch reads of its work.
#ifndef COMPUTE_GLSL
#define COMPUTE_GLSL
#include "stage/tile_words.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

layout(push_constant) uniform Pushed {
    uint first;    // number of the first record
    uint count;    // of records
    uint heads;    // word of list_words where the heads of their lists begin
    uint tiles;    // word where the lists' tiles begin
    uint list;     // which of the lists a dispatch takes
    uint solid;    // number of the only solid
    uint instance; // number of the only instance
} pushed;

// Lists of tiles, made by tile_lists.comp for N records:
// - TILE_LISTS heads of four words: an indirect dispatch of a work group for each tile in the list, one unused;
// - for each list 4 N words: a tile's corner, the number of its instance, the two runs of patches that its rays may
//   meet, first | number << 9 | first << 15 | number << 24, and one unused. Tiles of the last list walk the tree; the
//   bits of the first and of the last t at which their rays may meet the solid stand in place of the runs.
#ifndef LIST_WORDS
#define LIST_WORDS readonly
#endif
layout(set = 2, binding = 6, std430) LIST_WORDS buffer ListWords {
    uint list_words[];
};

// Where the head of list number `k` is.
uint list_head(uint k)
{
    return pushed.heads + 4u * k;
}

// Where its tiles begin.
uint list_tiles(uint k)
{
    return pushed.tiles + 4u * k * pushed.count;
}

#endif
