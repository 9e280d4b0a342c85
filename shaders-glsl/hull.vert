#version 450
#extension GL_GOOGLE_include_directive : require
// The hull of each instance: two rings of corners for every band, with what its fragments test.
#include "include/vertex.glsl"
#include "include/hull_varyings.glsl"
#include "include/bands.glsl"

void main()
{
    frame = frame_block;
    solid = batch_solid;
    Instance i = batch_instance(gl_InstanceIndex);
    uint at = this_band();
    gl_Position = frame.clip_from_world * vec4(point_to_world(i, band_corner(at)), 1.0);

    // Rays are counted from a depth near the solid, or r^2 would cancel.
    float base = dot(point_to_world(i, vec3(0.0, 0.0, 0.5)) - frame.eye.xyz, frame.forward.xyz);
    hand_over(i, gl_InstanceIndex, base);
    for (uint k = 0u; k < TESTS; ++k) {
        hull_quadric[k] = uintBitsToFloat(piece_tables[at + 1u + 2u * k]);
        hull_guard[k] = uintBitsToFloat(piece_tables[at + 2u + 2u * k]);
    }
}
