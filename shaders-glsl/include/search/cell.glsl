// Intersects the ray of a fragment with the patches of its cell, without branches unless the box cuts the solid.
// src/surface/hull.rs defines cells and proves that no ray is lost.
#ifndef CELL_GLSL
#define CELL_GLSL
#extension GL_EXT_control_flow_attributes : require
#include "stage/cell_varyings.glsl"
#include "search/patch_row.glsl"
#include "core/trace.glsl"

bool trace_cell(vec2 pixel, out Hit hit)
{
    load_varyings();
    PixelRays rays = varying_rays();
    // The shell is near the surface.
    float shift = ORTHO != 0u ? middle_of(rays, pixel) : 1.0 / gl_FragCoord.w - rays.base;
    PatchRow row = begin_row(rays, pixel, shift);
    const float SIDE_SLACK = 4e-6; // object units; a hit so close before a side of the box counts
    float eye = row.least;
    bool by_side = false;
    if (CUT_CELLS != 0u) {
        clip_to_sides(row);
        by_side = row.least > eye && row.least < row.most;
        row.least -= SIDE_SLACK * inversesqrt(row.m.a + row.m.v.z * row.m.v.z);
    }
    bool entered = false;
    const uint TESTS = SINGLE_CELLS != 0u ? 1u : PATCHES_PER_CELL;
    // SwiftShader skips a loop without rounds, but executes both sides of a branch.
    for (uint k = 0u; k < FETCHED_CELLS * TESTS; ++k) {
        uint at = (floatBitsToUint(window_record.w) & ~INDEX_BITS) + 2u * k;
        vec4 quadric = uintBitsToFloat(stored_vector(at + 1u));
        vec4 guard = uintBitsToFloat(stored_vector(at + 2u));
        entered = take_nearer(row.m, quadric, guard, row.least, row.best, row.quadric) || entered;
    }
    if (FETCHED_CELLS == 0u) {
        entered = take_nearer(row.m, cell_quadric[0], cell_guard[0], row.least, row.best, row.quadric);
    }
    if (FETCHED_CELLS == 0u && SINGLE_CELLS == 0u) {
        [[unroll]] for (uint k = 1u; k < PATCHES_PER_CELL; ++k) {
            entered = take_nearer(row.m, cell_quadric[k], cell_guard[k], row.least, row.best, row.quadric) || entered;
        }
    }
    bool found = end_row(row, TESTS, hit);
    // A ray that enters the solid before a side may be in the solid there, or leave it into the shell of a cell that it
    // then enters from behind. The fragment of the cell where it entered searches all of the box.
    if (CUT_CELLS != 0u && by_side && entered) {
        RayStart start = FROM_EYE;
        found = trace_solid(row.m.o, row.m.v, -eye, eye, false, start, hit);
        hit.t += row.shift;
    }
    return found;
}

#endif
