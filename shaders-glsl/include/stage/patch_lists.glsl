// Lists of the patches that the rays of a tile of GROUP_PIXELS^2 may meet: two runs of patches that follow each other.
// list.comp makes them for the tiles of one instance, list_copies.comp for tiles of any of a batch's; listed.comp reads
// them; src/gpu/plan.rs says where they are.
//
// Tables, in vectors: the number of patches and the bits of the unit of radii; three vectors a patch: its quadric, its
// guard, what beam.glsl asks of it; then a record that nothing passes; then of SOLID_ROWS rows the radius within which
// all is solid, four to a vector.
//
// Words, from pushed.first_bin on, for N tiles: a dispatch and four words a tile (beams.glsl; of several instances
// bin_words.glsl), of tiles whose lists would be too long; TILE_LISTS dispatches; for each 2 N words: of a tile,
// x | y << 16 (of several instances the word of its bin), and its runs: first | number << 9 | first << 15 | number << 24.
// The last of these lists is of tiles whose rays enter box and solid at once, without runs.
#ifndef PATCH_LISTS_GLSL
#define PATCH_LISTS_GLSL
#include "stage/beams.glsl"

uint list_heads()
{
    return pushed.first_bin + 4u + 4u * pushed.tiles;
}

// Of list number `k`: where the words of its tiles begin.
uint list_tiles(uint k)
{
    return list_heads() + 4u * TILE_LISTS + 2u * k * pushed.tiles;
}

#endif
