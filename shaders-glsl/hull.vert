#version 450
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require
// The hull of each instance: two rings of corners for every frustum, with what its fragments test.
#include "stage/vertex.glsl"
#include "stage/hull_varyings.glsl"
#include "stage/frusta.glsl"

void main()
{
    Instance i = begin();
    uint at = this_frustum();
    gl_Position = clip_of(i, frustum_corner(at));

    hand_over(i, frame.forward.w);
    [[unroll]] for (uint k = 0u; k < PATCHES_PER_CELL; ++k) {
        hull_quadric[k] = uintBitsToFloat(patch_tables[at + 1u + 2u * k]);
        hull_guard[k] = uintBitsToFloat(patch_tables[at + 2u + 2u * k]);
    }
}
