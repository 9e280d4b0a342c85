// Runs of patches that a tile's rays may hit, and the tile of a bin made from them.
//
// Layout of the table, in vectors: first a header with the number of patches, the unit of radii and the unit of roundings
// (float bits), and the range of patches that is_imprecise() of beam.glsl is true for at most (first | last << 16). Then
// three vectors per patch: its quadric, its guard, its bounds (read by beam.glsl). The last record is one without hits.
#ifndef PATCH_RUNS_GLSL
#define PATCH_RUNS_GLSL
#include "stage/walk_lists.glsl"

// The first and the last patch, and the widest gap between two successive ones.
struct PatchRuns {
    uint first;
    uint last;
    uvec2 gap;
    bool any;
};

const PatchRuns NO_PATCHES = PatchRuns(0u, 0u, uvec2(0u), false);

// Adds patch `k` to the runs if `meets` is true. Calls must have ascending `k`.
void take_patch(inout PatchRuns runs, uint k, bool meets)
{
    runs.gap = meets && runs.any && k - runs.last > runs.gap.y - runs.gap.x ? uvec2(runs.last, k) : runs.gap;
    runs.first = meets && !runs.any ? k : runs.first;
    runs.last = meets ? k : runs.last;
    runs.any = runs.any || meets;
}

// Returns the number of patches of each run.
uvec2 lengths_of(PatchRuns runs)
{
    bool split = runs.gap.y - runs.gap.x > 1u;
    return split ? uvec2(runs.gap.x + 1u - runs.first, runs.last + 1u - runs.gap.y)
                 : uvec2(runs.last + 1u - runs.first, 0u);
}

// Adds a tile if its runs are short enough for a list. Returns false if not; then the tile must use the tree. `by_tip`:
// rays begin at the height `tip`.
bool append_runs(uvec2 corner, uint instance, PatchRuns runs, bool by_tip, float tip)
{
    uvec2 lengths = lengths_of(runs);
    uint listed = lengths.x + lengths.y;
    if (listed > LONGEST_LIST) {
        return false;
    }
    uint n = uint(listed > SHORT_LIST) + uint(listed > MIDDLE_LIST) + uint(listed > LONG_LIST);
    uint found = runs.first | lengths.x << 9 | runs.gap.y << 15 | lengths.y << 24 | uint(by_tip) << 31;
    BinTile tile = BinTile(square_of(corner), instance, uvec2(found, floatBitsToUint(by_tip ? tip : 0.5)));
    bin_tiles[pushed.tiles + n * pushed.room + count_tile(pushed.heads + n)] = tile;
    return true;
}

#endif
