#version 450
#extension GL_GOOGLE_include_directive : require
// Traces a pixel of a shape box: colour and depth.
#include "include/box_fragment.glsl"

layout(depth_greater) out float gl_FragDepth;
layout(location = 0) out vec4 color;

void main()
{
    uvec2 pixel = uvec2(gl_FragCoord.xy);
    Hit hit;
    if (!trace_box(pixel, hit)) {
        discard;
    }
    color = shade_fragment(pixel, hit).color;
    gl_FragDepth = depth_of(hit.t);
}
