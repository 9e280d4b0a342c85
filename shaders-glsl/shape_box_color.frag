#version 450
#extension GL_GOOGLE_include_directive : require
// Traces a pixel of a shape box: colour and depth.
#include "include/box_varyings.glsl"

layout(depth_greater) out float gl_FragDepth;
layout(location = 0) out vec4 color;

void main()
{
    solid = batch_solid;
    uvec2 pixel = uvec2(gl_FragCoord.xy);
    Hit hit;
    if (!trace(ray_eye, ray_direction(varying_rays(), pixel), hit)) {
        discard;
    }
    color = shade(batch_instance(instance_index), varying_rays(), pixel, hit).color;
    gl_FragDepth = depth_of(hit.t);
}
