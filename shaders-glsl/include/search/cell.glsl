// Intersects the ray of a fragment with the patches of its cell, without branches. src/surface/hull.rs defines
// cells and proves that no ray is lost; `trace_hull` of tests/common/walk.rs is the CPU twin of this file.
#ifndef CELL_GLSL
#define CELL_GLSL
#extension GL_EXT_control_flow_attributes : require
#include "stage/cell_varyings.glsl"
#include "search/patch_row.glsl"

bool trace_cell(vec2 pixel, out Hit hit)
{
    take_over();
    PatchRow row = begin_row(varying_rays(), pixel);
    // SwiftShader skips a loop without rounds, but executes both sides of a branch.
    for (uint k = 0u; k < FETCHED_CELLS * PATCHES_PER_CELL; ++k) {
        uint at = cell_record + 2u * k;
        vec4 quadric = uintBitsToFloat(patch_tables[at + 1u]);
        vec4 guard = uintBitsToFloat(patch_tables[at + 2u]);
        take_nearer(row.m, quadric, guard, row.least, row.best, row.quadric);
    }
    if (FETCHED_CELLS == 0u) {
        [[unroll]] for (uint k = 0u; k < PATCHES_PER_CELL; ++k) {
            take_nearer(row.m, cell_quadric[k], cell_guard[k], row.least, row.best, row.quadric);
        }
    }
    return end_row(row, PATCHES_PER_CELL, hit);
}

#endif
