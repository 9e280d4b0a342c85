#version 450
#extension GL_GOOGLE_include_directive : require
// A pixel of a mesh: every plane.
#include "shade.glsl"

layout(location = 0) out vec4 color;
layout(location = 1) out vec4 normal_distance;
layout(location = 2) out vec4 shading_normal_u;
layout(location = 3) out vec4 albedo_v;

void main()
{
    Shaded s = shade();
    color = s.color;
    normal_distance = vec4(s.normal, s.distance);
    shading_normal_u = vec4(s.shading_normal, s.uv.x);
    albedo_v = vec4(s.albedo, s.uv.y);
}
