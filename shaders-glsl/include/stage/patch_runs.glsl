// The runs of patches that a tile's rays may meet, and the list that they make.
#ifndef PATCH_RUNS_GLSL
#define PATCH_RUNS_GLSL
#include "stage/patch_lists.glsl"

// The first and the last patch, and the widest gap between two that follow.
struct PatchRuns {
    uint first;
    uint last;
    uvec2 gap;
    bool any;
};

const PatchRuns NO_PATCHES = PatchRuns(0u, 0u, uvec2(0u), false);

// Patches come in their order.
void take_patch(inout PatchRuns runs, uint k, bool meets)
{
    runs.gap = meets && runs.any && k - runs.last > runs.gap.y - runs.gap.x ? uvec2(runs.last, k) : runs.gap;
    runs.first = meets && !runs.any ? k : runs.first;
    runs.last = meets ? k : runs.last;
    runs.any = runs.any || meets;
}

// How many patches each run has.
uvec2 lengths_of(PatchRuns runs)
{
    bool split = runs.gap.y - runs.gap.x > 1u;
    return split ? uvec2(runs.gap.x + 1u - runs.first, runs.last + 1u - runs.gap.y)
                 : uvec2(runs.last + 1u - runs.first, 0u);
}

// `n`: which of the lists; `tile`: its first word there.
void append(uint n, uint tile, uint runs)
{
    uint at = list_tiles(n) + 2u * atomicAdd(bin_words[list_heads() + 4u * n], 1u);
    bin_words[at] = tile;
    bin_words[at + 1u] = runs;
}

// `lengths` are those of the runs, together LONGEST_LIST at most.
void append_patches(uint tile, PatchRuns runs, uvec2 lengths)
{
    uint listed = lengths.x + lengths.y;
    uint n = uint(listed > SHORT_LIST) + uint(listed > MIDDLE_LIST) + uint(listed > LONG_LIST);
    append(n, tile, runs.first | lengths.x << 9 | runs.gap.y << 15 | lengths.y << 24);
}

#endif
