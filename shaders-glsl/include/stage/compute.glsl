// Inputs of every dispatch: push constants and lists of tiles.
#ifndef COMPUTE_GLSL
#define COMPUTE_GLSL
#include "stage/tile_words.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

layout(push_constant) uniform Pushed {
    uint first;    // index of the first record
    uint count;    // number of records
    uint heads;    // first word of the list heads in list_words
    uint tiles;    // first word of the lists' tiles in list_words
    uint list;     // index of the list that this dispatch reads
    uint solid;    // index of the only solid
    uint instance; // index of the only instance
} pushed;

// Lists of tiles, written by tile_lists.comp for N records:
// - TILE_LISTS heads of four words: an indirect dispatch with one work group per tile in the list, and one unused word;
// - 4 N words per list. A tile has four words: its corner, the index of its instance, the two runs of patches that its
//   rays may hit (first | number << 9 | first << 15 | number << 24), and one unused word. Tiles of the last list use
//   the tree. They hold the range of t of possible hits, as two floats, in place of the runs and the unused word.
#ifndef LIST_WORDS
#define LIST_WORDS readonly
#endif
layout(set = 2, binding = 6, std430) LIST_WORDS buffer ListWords {
    uint list_words[];
};

// Returns the first word of the head of list `k`.
uint list_head(uint k)
{
    return pushed.heads + 4u * k;
}

// Returns the first word of the tiles of list `k`.
uint list_tiles(uint k)
{
    return pushed.tiles + 4u * k * pushed.count;
}

#endif
