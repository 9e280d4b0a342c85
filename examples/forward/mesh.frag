#version 450
#extension GL_GOOGLE_include_directive : require
// The host's light on a mesh.
#define LIGHT_SET 0
#include "light.glsl"
layout(location = 0) in vec3 color;
layout(location = 1) in vec3 world_normal;
layout(location = 2) in vec3 world;
layout(location = 0) out vec4 target;

void main()
{
    vec3 to_eye = normalize(host_lights.eye.xyz - world);
    target = vec4(host_lit(world, normalize(world_normal), to_eye, color, 0.4, 0.0), 1.0);
}
