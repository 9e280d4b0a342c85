#version 450
#extension GL_GOOGLE_include_directive : require
// The floor of cells: the same corners, and of the cell's patches the first.
#include "stage/vertex.glsl"
#include "core/patch_tables.glsl"

layout(location = 11) flat out vec4 first_quadric;

void main()
{
    Instance i = begin(uint(gl_InstanceIndex));
    uint at = solid.hull.x + FRUSTUM_VECTORS * (uint(gl_VertexIndex) / (2u * HULL_SIDES));
    uint vertex = uint(gl_VertexIndex) % (2u * HULL_SIDES);
    vec4 rings = uintBitsToFloat(patch_tables[at]);
    vec2 rz = vertex < HULL_SIDES ? rings.xy : rings.zw;
    float angle = float(vertex % HULL_SIDES) * (6.28318530717958648 / float(HULL_SIDES));
    gl_Position = clip_of(i, vec3(rz.x * cos(angle), rz.x * sin(angle), rz.y) + vec3(solid.axis.xy, 0.0));

    hand_over(i, frame.forward.w);
    first_quadric = uintBitsToFloat(patch_tables[at + 1u]);
}
