#version 450
#extension GL_GOOGLE_include_directive : require
// The host's sun on a mesh.
#define LIGHT_SET 0
#include "sun.glsl"
layout(location = 0) in vec3 color;
layout(location = 1) in vec3 world_normal;
layout(location = 2) in vec3 world;
layout(location = 0) out vec4 target;

void main()
{
    vec3 n = normalize(world_normal);
    target = host_lit(world, n, n, normalize(host_sun.eye.xyz - world), color);
}
