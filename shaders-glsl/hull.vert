#version 450
#extension GL_GOOGLE_include_directive : require
// The hull of each instance.
#include "stage/hull_vertex.glsl"

void main()
{
    place_hull_vertex();
}
