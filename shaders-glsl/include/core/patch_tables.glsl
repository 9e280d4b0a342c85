// Tables of quadric patches. The tables of a level, in this order:
// - ranges of z in front of the start, two records per vector, the first ones last;
// - words, four per vector: first PATCH_NODES nodes of the tree, level by level. A node holds the least r^2 (rounded
//   down, low half) and the largest (rounded up, high half) in units of shape.table_fact_2. The runs of the rows follow,
//   first << RUN_BITS | count;
// - records from FIRST_RECORD on, two vectors each: a patch's quadric, its guard.
// Frusta of cells are stored separately (proxy_cells.vert).
#ifndef PATCH_TABLES_GLSL
#define PATCH_TABLES_GLSL
#extension GL_EXT_samplerless_texture_functions : require
#include "core/shape_map.glsl"

layout(set = 0, binding = 4, std430) readonly buffer PatchTables {
    uvec4 patch_tables[];
};
layout(set = 0, binding = 10) uniform utextureBuffer table_texels;

// Tables of a draw or dispatch that has one object, of all its levels; for listed patches, their table. Software
// drivers gather from uniform buffers several times faster.
layout(set = 0, binding = 5, std140) uniform OwnPatchTables {
    uvec4 own_patch_tables[OWN_VECTORS];
};

uvec4 stored_vector(uint vector)
{
#ifndef STORED_TABLES
    if (TEXELS != 0u) {
        return texelFetch(table_texels, int(vector));
    }
#endif
    return patch_tables[vector];
}

const uint RUN_BITS = 12u;
const uint FIRST_RECORD = (PATCH_NODES + PATCH_ROWS) / 4u;

uint patch_word(uint at)
{
    uint vector = shape.table + (at >> 2);
    return OWN_TREE ? own_patch_tables[vector][at & 3u] : stored_vector(vector)[at & 3u];
}

vec4 patch_vector(uint at)
{
    uint vector = shape.table + at;
    return uintBitsToFloat(OWN_TREE ? own_patch_tables[vector] : stored_vector(vector));
}

// Returns a vector of the table of listed patches.
uvec4 listed_table(uint at)
{
    uint vector = shape.listed + at;
    return OWN_TABLES ? own_patch_tables[vector] : stored_vector(vector);
}

// Returns the header of that table (stage/patch_runs.glsl). Indices of shared memory follow from its number of patches,
// so the number is bounded here.
uvec4 listed_header()
{
    uvec4 header = listed_table(0u);
    header.x = min(header.x, LISTED_PATCHES);
    return header;
}

// Returns one component of such a vector: software drivers load each component lane by lane.
uint listed_word(uint at, uint k)
{
    uint vector = shape.listed + at;
    return OWN_TABLES ? own_patch_tables[vector][k] : stored_vector(vector)[k];
}

// Returns the least and largest r^2 of a node.
vec2 node_extent(uint word)
{
    return vec2(word & 0xffffu, word >> 16) * uintBitsToFloat(shape.table_fact_2);
}

#endif
