#version 450
#extension GL_GOOGLE_include_directive : require
// A vertex of a tessellated solid. The normal's azimuth is the point's own.
#include "include/vertex.glsl"

layout(location = 0) in vec3 position; // object units about the axis
layout(location = 1) in vec2 normal;   // (r, z) in the half-plane
layout(location = 11) out vec4 surface; // x, y; normal

void main()
{
    frame = frame_block;
    solid = batch_solid;
    Instance i = batch_instance(gl_InstanceIndex);
    vec3 p = position + vec3(solid.axis.xy, 0.0);
    gl_Position = frame.clip_from_world * vec4(point_to_world(i, p), 1.0);
    surface = vec4(position.xy, normal);
    hand_over(i, gl_InstanceIndex, 0.0);
}
