// Inputs of every dispatch: push constants and bins of tiles.
#ifndef COMPUTE_GLSL
#define COMPUTE_GLSL
#include "stage/tile_words.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

layout(push_constant) uniform Pushed {
    uint first;    // index of the first record
    uint count;    // number of records
    uint heads;    // first word of the heads of bins in bin_words
    uint records;  // first word of the records of bins in bin_words
    uint bin;      // index of the bin that this dispatch reads
    uint object;   // index of the only object
    uint instance; // index of its only copy
} pushed;

// Bins of tiles by the length of their lists of patches, filled by tile_lists.comp from N records:
// - TILE_BINS heads of four words: an indirect dispatch with one work group per record in the bin, and one unused word;
// - 4 N words per bin. A record has four words: its corner, the index of its instance, the two runs of patches that its
//   rays may hit (first | number << 9 | first << 15 | number << 24), and one unused word. Tiles of the last bin use
//   the tree. They hold the range of t of possible hits, as two floats, in place of the runs and the unused word.
#ifndef BIN_WORDS
#define BIN_WORDS readonly
#endif
layout(set = 2, binding = 6, std430) BIN_WORDS buffer BinWords {
    uint bin_words[];
};

// Returns the first word of the records of bin `k`.
uint bin_records(uint k)
{
    return pushed.records + 4u * k * pushed.count;
}

#endif
