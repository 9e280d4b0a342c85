#version 450
#extension GL_GOOGLE_include_directive : require
// Solves a fragment of a hull: colour and depth.
#include "include/hull.glsl"

layout(depth_greater) out float gl_FragDepth;
layout(location = 0) out vec4 color;

void main()
{
    uvec2 pixel = uvec2(gl_FragCoord.xy);
    Hit hit;
    if (!trace_hull(pixel, hit)) {
        discard;
    }
    color = shade_fragment(pixel, hit).color;
    gl_FragDepth = hull_depth(hit.t);
}
