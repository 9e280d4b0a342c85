#version 450
#extension GL_GOOGLE_include_directive : require
// The hull of each instance: two rings of corners for every frustum, with what its fragments test.
#include "stage/vertex.glsl"
#include "stage/hull_varyings.glsl"
#include "stage/frusta.glsl"

void main()
{
    Instance i = begin();
    uint at = this_band();
    gl_Position = frame.clip_from_world * vec4(point_to_world(i, band_corner(at)), 1.0);

    // Rays are counted from a depth near the solid, or r^2 would cancel.
    float base = dot(point_to_world(i, vec3(0.0, 0.0, 0.5)) - frame.eye.xyz, frame.forward.xyz);
    hand_over(i, base, frame.forward.w);
    for (uint k = 0u; k < PATCHES_PER_CELL; ++k) {
        hull_quadric[k] = uintBitsToFloat(patch_tables[at + 1u + 2u * k]);
        hull_guard[k] = uintBitsToFloat(patch_tables[at + 2u + 2u * k]);
    }
}
