#version 450
#extension GL_GOOGLE_include_directive : require
// A vertex of a mesh in a shadow map.
#define CASTER
#include "mesh.glsl"

layout(location = 0) in vec3 position; // object units about the axis

void main()
{
    Instance i = instances[gl_InstanceIndex];
    vec3 world = i.position_sx.xyz + rotate(i.rotation, scale_of(i) * (position + vec3(caster.axis.xy, 0.0)));
    gl_Position = caster.clip_from_world * vec4(world, 1.0);
}
