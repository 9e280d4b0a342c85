// Where pieces of quadrics are kept: trees, rows and records of search_quadric.glsl, bands of hull.vert.
#ifndef PIECE_TABLES_GLSL
#define PIECE_TABLES_GLSL
#include "blocks.glsl"

// Of the search, nodes: (min r^2, max r^2, bits of the row's run, 0), level by level; then records: 3 vectors each.
layout(set = 0, binding = 4, std430) readonly buffer PieceTables {
    vec4 piece_tables[];
};

// The batch's own tables alone: software drivers gather from uniform buffers several times as fast.
layout(set = 0, binding = 5, std140) uniform OwnPieceTables {
    vec4 own_piece_tables[PIECE_VECTORS];
};

vec4 piece_table(uint at)
{
    if (OWN_TABLES != 0u && (SHADOW == SHADOW_OFF || shadow_map < 0)) {
        return own_piece_tables[at];
    }
    return piece_tables[solid.pieces.x + at];
}

#endif
