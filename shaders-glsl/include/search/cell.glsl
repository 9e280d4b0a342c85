// Intersects the ray of a fragment with the patches of its cell, without branches. src/surface/hull.rs defines
// cells and proves that no ray is lost; `trace_hull` of tests/common/walk.rs is the CPU twin of this file.
#ifndef CELL_GLSL
#define CELL_GLSL
#extension GL_EXT_control_flow_attributes : require
#include "stage/cell_varyings.glsl"
#include "search/patch_row.glsl"

const float SIDE_SLACK = 4e-6; // object units; a hit so close before a side of the box counts

bool trace_cell(vec2 pixel, out Hit hit)
{
    take_over();
    PatchRow row = begin_row(varying_rays(), pixel);
    float slack = SIDE_SLACK * inversesqrt(row.m.a + row.m.v.z * row.m.v.z);
    bool by_side = false;
    if (OUTSIDE == 0u) {
        float eye = row.least;
        clip_to_sides(row);
        by_side = row.least > eye && row.least < row.most;
        row.least -= slack;
    }
    // SwiftShader skips a loop without rounds, but executes both sides of a branch.
    for (uint k = 0u; k < FETCHED_CELLS * PATCHES_PER_CELL; ++k) {
        uint at = cell_record + 2u * k;
        take_nearer(row, uintBitsToFloat(patch_tables[at + 1u]), uintBitsToFloat(patch_tables[at + 2u]));
    }
    if (FETCHED_CELLS == 0u) {
        [[unroll]] for (uint k = 0u; k < PATCHES_PER_CELL; ++k) {
            take_nearer(row, cell_quadric[k], cell_guard[k]);
        }
    }
    bool found = end_row(row, PATCHES_PER_CELL, hit);
    // A ray that is in the solid where it passes a side of the box has entered the solid before, so it has a fragment
    // in the cell where it entered, and this fragment draws the cut.
    if (OUTSIDE == 0u && by_side && row.entered) {
        Meridian side = row.m;
        float t = row.least + slack;
        side.o += t * side.v;
        side.c = dot(side.o.xy, side.o.xy);
        if (starts_within(side)) {
            vec2 across = abs(side.o.xy + object.axis.xy);
            hit.t = t;
            hit.normal = face_normal(across.x > across.y ? FACE_X : FACE_Y, side.v, -1.0);
            hit.point = side.o;
            found = true;
        }
    }
    return found;
}

#endif
