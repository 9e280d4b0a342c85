#version 450
#extension GL_GOOGLE_include_directive : require
// A vertex of a tessellated solid. What is handed on is one vector: the normal's azimuth is the point's own.
#include "include/placement.glsl"

layout(location = 0) in vec3 position; // object units about the axis
layout(location = 1) in vec2 normal;   // (r, z) in the half-plane
layout(location = 0) out vec4 surface; // x, y; normal
layout(location = 1) flat out uint instance_index;

void main()
{
    Instance i = batch_instance(gl_InstanceIndex);
    vec3 p = position + vec3(batch_solid.axis.xy, 0.0);
    gl_Position = frame.clip_from_world * vec4(point_to_world(i, p), 1.0);
    surface = vec4(position.xy, normal);
    if (SINGLE == 0u) {
        instance_index = gl_InstanceIndex; // what is not written is not interpolated
    }
}
