// Where patches of quadrics are kept. Of a solid's tables, in this order:
// - words, four to a vector: PATCH_NODES nodes of the tree, level by level, each the least r^2 (rounded down, low half)
//   and the largest (rounded up, high half) in units of solid.patches.w; then the runs of the rows, first << RUN_BITS |
//   count;
// - records, two vectors each, from solid.patches.y on: a patch's quadric, its guard;
// - from solid.patches.z on, two records a vector: their ranges of z.
// Frusta of cells stand by themselves (proxy_cells.vert).
#ifndef PATCH_TABLES_GLSL
#define PATCH_TABLES_GLSL
#include "core/shape_map.glsl"

layout(set = 0, binding = 4, std430) readonly buffer PatchTables {
    uvec4 patch_tables[];
};

// The only tables that a draw or dispatch reads; of listed patches these. Software drivers gather from uniform buffers
// several times as fast.
layout(set = 0, binding = 5, std140) uniform OwnPatchTables {
    uvec4 own_patch_tables[OWN_VECTORS];
};

const uint RUN_BITS = 12u;

bool takes_own_tables()
{
#if SHADOWED
    return OWN_TABLES != 0u && !casts;
#else
    return OWN_TABLES != 0u;
#endif
}

uint patch_word(uint at)
{
    if (takes_own_tables()) {
        return own_patch_tables[at >> 2][at & 3u];
    }
    return patch_tables[solid.patches.x + (at >> 2)][at & 3u];
}

vec4 patch_vector(uint at)
{
    if (takes_own_tables()) {
        return uintBitsToFloat(own_patch_tables[at]);
    }
    return uintBitsToFloat(patch_tables[solid.patches.x + at]);
}

// A vector of the patches that lists are made from.
uvec4 listed_table(uint at)
{
    return OWN_TABLES != 0u ? own_patch_tables[at] : patch_tables[solid.hull.z + at];
}

// A component of one: software drivers load each component lane by lane.
uint listed_word(uint at, uint k)
{
    return OWN_TABLES != 0u ? own_patch_tables[at][k] : patch_tables[solid.hull.z + at][k];
}

// Least and largest r^2.
vec2 node_extent(uint word)
{
    return vec2(word & 0xffffu, word >> 16) * uintBitsToFloat(solid.patches.w);
}

#endif
