// Intersects the ray of a fragment with the patches of its cell, without branches. src/surface/hull.rs defines
// cells and proves that no ray is lost; `trace_hull` of tests/common/walk.rs is the CPU twin of this file.
#ifndef CELL_GLSL
#define CELL_GLSL
#extension GL_EXT_control_flow_attributes : require
#include "stage/cell_varyings.glsl"
#include "search/patch_row.glsl"

bool trace_cell(uvec2 pixel, out Hit hit)
{
    take_over();
    PatchRow row = begin_row(varying_rays(), pixel, cell_sides);
    [[unroll]] for (uint k = 0u; k < PATCHES_PER_CELL; ++k) {
        vec4 quadric = cell_quadric[k];
        vec4 guard = cell_guard[k];
        if (FETCHED_CELLS != 0u) {
            quadric = uintBitsToFloat(patch_tables[cell_record + 2u * k + 1u]);
            guard = uintBitsToFloat(patch_tables[cell_record + 2u * k + 2u]);
        }
        take_patch_of_row(row, quadric, guard);
    }
    return end_row(row, PATCHES_PER_CELL, hit);
}

#endif
