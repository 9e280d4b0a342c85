#version 450
#extension GL_GOOGLE_include_directive : require
// The floor of proxy hulls: the same corners, and of the cell's patches the first.
#include "stage/vertex.glsl"
#include "stage/frusta.glsl"

layout(location = 11) flat out vec4 first_quadric;

void main()
{
    Instance i = begin(uint(gl_InstanceIndex));
    uint at = this_frustum();
    gl_Position = clip_of(i, frustum_corner(at));

    hand_over(i, frame.forward.w);
    first_quadric = uintBitsToFloat(patch_tables[at + 1u]);
}
