#version 450
#extension GL_GOOGLE_include_directive : require
// A pixel of a mesh: colour alone.
#include "shade.glsl"

layout(location = 0) out vec4 color;

void main()
{
    color = shade().color;
}
