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
#ifdef CUT
    const float SIDE_SLACK = 4e-6; // object units; a hit so close before a side of the box counts
    float eye = row.least;
    clip_to_sides(row);
    bool by_side = row.least > eye && row.least < row.most;
    float side_t = row.least;
    row.least -= SIDE_SLACK * inversesqrt(row.m.a + row.m.v.z * row.m.v.z);
#endif
    bool entered = false;
    // SwiftShader skips a loop without rounds, but executes both sides of a branch.
    for (uint k = 0u; k < FETCHED_CELLS * PATCHES_PER_CELL; ++k) {
        uint at = cell_record + 2u * k;
        vec4 quadric = uintBitsToFloat(patch_tables[at + 1u]);
        vec4 guard = uintBitsToFloat(patch_tables[at + 2u]);
        entered = take_nearer(row.m, quadric, guard, row.least, row.best, row.quadric) || entered;
    }
    if (FETCHED_CELLS == 0u) {
        [[unroll]] for (uint k = 0u; k < PATCHES_PER_CELL; ++k) {
            entered = take_nearer(row.m, cell_quadric[k], cell_guard[k], row.least, row.best, row.quadric) || entered;
        }
    }
    bool found = end_row(row, PATCHES_PER_CELL, hit);
#ifdef CUT
    // A ray that is in the solid where it passes a side of the box has entered the solid before, so it has a fragment
    // in the cell where it entered, and this fragment draws the cut.
    if (by_side && entered) {
        Meridian side = row.m;
        side.o += side_t * side.v;
        side.c = dot(side.o.xy, side.o.xy);
        if (starts_within(side)) {
            vec2 across = abs(side.o.xy + object.axis.xy);
            hit.t = side_t;
            hit.normal = face_normal(across.x > across.y ? FACE_X : FACE_Y, side.v, -1.0);
            hit.point = side.o;
            found = true;
        }
    }
#endif
    return found;
}

#endif
