#version 450
#extension GL_GOOGLE_include_directive : require
// The hull of each instance, as far as it is within the box's sides. What begins beyond these is drawn by sides.vert.
#include "stage/hull_vertex.glsl"

out float gl_ClipDistance[4];

void main()
{
    vec3 corner = place_hull_vertex();
    float R = solid.bounds.x + 1e-3; // no rounding takes a triangle away that begins within
    gl_ClipDistance[0] = R - corner.x;
    gl_ClipDistance[1] = R + corner.x;
    gl_ClipDistance[2] = R - corner.y;
    gl_ClipDistance[3] = R + corner.y;
}
