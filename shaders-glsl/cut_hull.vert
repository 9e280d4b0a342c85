#version 450
#extension GL_GOOGLE_include_directive : require
// The hull of each instance, as far as it is within the box's sides. What begins beyond these is drawn by sides.vert.
#include "stage/hull_vertex.glsl"

out float gl_ClipDistance[4];

void main()
{
    vec3 corner = place_hull_vertex();
    // No triangle is taken away that begins within the sides, as they are drawn.
    vec2 side = solid.bounds.x + max(fraction_of_pixel(instances[gl_InstanceIndex]).xy, 1e-3);
    gl_ClipDistance[0] = side.x - corner.x;
    gl_ClipDistance[1] = side.x + corner.x;
    gl_ClipDistance[2] = side.y - corner.y;
    gl_ClipDistance[3] = side.y + corner.y;
}
