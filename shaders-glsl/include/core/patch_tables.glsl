// Tables of quadric patches. The tables of an object, in this order:
// - words, four per vector: first PATCH_NODES nodes of the tree, level by level. A node holds the least r^2 (rounded
//   down, low half) and the largest (rounded up, high half) in units of object.patches.w. The runs of the rows follow,
//   first << RUN_BITS | count;
// - records from object.patches.y, two vectors each: a patch's quadric, its guard;
// - ranges of z from object.patches.z, two records per vector.
// Frusta of cells are stored separately (proxy_cells.vert).
#ifndef PATCH_TABLES_GLSL
#define PATCH_TABLES_GLSL
#include "core/shape_map.glsl"

layout(set = 0, binding = 4, std430) readonly buffer PatchTables {
    uvec4 patch_tables[];
};

// Tables of a draw or dispatch that reads only one; for listed patches, their table. Software drivers gather from
// uniform buffers several times faster.
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
    return patch_tables[object.patches.x + (at >> 2)][at & 3u];
}

vec4 patch_vector(uint at)
{
    if (takes_own_tables()) {
        return uintBitsToFloat(own_patch_tables[at]);
    }
    return uintBitsToFloat(patch_tables[object.patches.x + at]);
}

// Returns a vector of the table of listed patches.
uvec4 listed_table(uint at)
{
    return OWN_TABLES != 0u ? own_patch_tables[at] : patch_tables[object.parts.z + at];
}

// Returns one component of such a vector: software drivers load each component lane by lane.
uint listed_word(uint at, uint k)
{
    return OWN_TABLES != 0u ? own_patch_tables[at][k] : patch_tables[object.parts.z + at][k];
}

// Returns the least and largest r^2 of a node.
vec2 node_extent(uint word)
{
    return vec2(word & 0xffffu, word >> 16) * uintBitsToFloat(object.patches.w);
}

#endif
