#version 450
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require
// Vertices of a proxy of cells: two rings of RING_CORNERS corners for each frustum, with the patches of its cell.
#include "stage/vertex.glsl"
#include "stage/cell_varyings.glsl"
#include "core/patch_tables.glsl"

void main()
{
    Instance i = begin(uint(gl_InstanceIndex));
    uint at = shape.first_frustum + FRUSTUM_VECTORS * (uint(gl_VertexIndex) / (2u * RING_CORNERS));
    uint vertex = uint(gl_VertexIndex) % (2u * RING_CORNERS);
    vec4 rings = uintBitsToFloat(stored_vector(at));
    vec2 rz = vertex < RING_CORNERS ? rings.xy : rings.zw;
    float angle = float(vertex % RING_CORNERS) * (6.28318530717958648 / float(RING_CORNERS));
    gl_Position = clip_of(i, vec3(rz.x * cos(angle), rz.x * sin(angle), rz.y) + vec3(shape.axis, 0.0));
    hand_over(i, frame.depth_sense);
    window_record.w = uintBitsToFloat(at | INDEX_BITS);
    if (FETCHED_CELLS == 0u) {
        cell_quadric[0] = uintBitsToFloat(stored_vector(at + 1u));
        cell_guard[0] = uintBitsToFloat(stored_vector(at + 2u));
    }
    if (FETCHED_CELLS == 0u && SINGLE_CELLS == 0u) {
        [[unroll]] for (uint k = 1u; k < PATCHES_PER_CELL; ++k) {
            cell_quadric[k] = uintBitsToFloat(stored_vector(at + 1u + 2u * k));
            cell_guard[k] = uintBitsToFloat(stored_vector(at + 2u + 2u * k));
        }
    }
}
