// Where pieces of quadrics are kept. Of a solid's tables, in this order:
// - words, four to a vector: PIECE_NODES nodes of the tree, level by level, each the least r^2 (rounded down, low half) and the largest
//   (rounded up, high half) in units of solid.pieces.w; then the runs of the rows, first << RUN_BITS | count;
// - records, two vectors each, from solid.pieces.y on: a piece's quadric, its guard;
// - from solid.pieces.z on, a vector a record: the range of z.
// Of the envelope of a map BEAM_NODES nodes alone. Bands of hulls stand by themselves (bands.glsl).
#ifndef PIECE_TABLES_GLSL
#define PIECE_TABLES_GLSL
#include "core/shape_map.glsl"

layout(set = 0, binding = 4, std430) readonly buffer PieceTables {
    uvec4 piece_tables[];
};

// The batch's own tables alone, but for the ranges: software drivers gather from uniform buffers several times as fast.
layout(set = 0, binding = 5, std140) uniform OwnPieceTables {
    uvec4 own_piece_tables[PIECE_VECTORS];
};

const uint RUN_BITS = 12u;

bool takes_own_tables()
{
#if SHADOWED
    return OWN_TABLES != 0 && !casts;
#else
    return OWN_TABLES != 0;
#endif
}

uint piece_word(uint at)
{
    if (takes_own_tables()) {
        return own_piece_tables[at >> 2][at & 3u];
    }
    return piece_tables[solid.pieces.x + (at >> 2)][at & 3u];
}

vec4 piece_vector(uint at)
{
    if (takes_own_tables()) {
        return uintBitsToFloat(own_piece_tables[at]);
    }
    return uintBitsToFloat(piece_tables[solid.pieces.x + at]);
}

// Least and largest r^2.
vec2 node_extent(uint word)
{
    return vec2(word & 0xffffu, word >> 16) * uintBitsToFloat(solid.pieces.w);
}

#endif
