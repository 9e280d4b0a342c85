#version 450
#extension GL_GOOGLE_include_directive : require
// The floor of cells: the same corners, and of the cell's patches the first.
#include "stage/vertex.glsl"
#include "core/patch_tables.glsl"

layout(location = 12) flat out vec4 first_quadric;

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
    first_quadric = uintBitsToFloat(stored_vector(at + 1u));
    first_quadric.y = uintBitsToFloat(stored_vector(at + 2u).x); // quadric_normal() reads the anchor
}
