// Lists of the patches that the rays of a tile of GROUP_PIXELS^2 may meet: two runs of patches that follow each other.
// list.comp makes them, listed.comp reads them; src/gpu/plan.rs says where they are.
//
// Tables, in vectors: the number of patches and the bits of the unit of radii; three vectors a patch: its quadric, its
// guard, what beam.glsl asks of it; then a record that nothing passes.
//
// Words, from pushed.first_bin on, for N tiles: a dispatch and four words a tile (beams.glsl), of tiles whose lists
// would be too long; a dispatch for each length of lists; for each length 2 N words: of a tile, x | y << 16, and its
// runs: first | number << 9 | first << 15 | number << 24.
#ifndef PATCH_LISTS_GLSL
#define PATCH_LISTS_GLSL
#include "stage/beams.glsl"

uint list_heads()
{
    return pushed.first_bin + 4u + 4u * pushed.tiles;
}

// Of the lists of length number `k`: where the words of its tiles begin.
uint list_tiles(uint k)
{
    return list_heads() + 4u * LIST_LENGTHS + 2u * k * pushed.tiles;
}

#endif
