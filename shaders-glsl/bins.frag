#version 450
#extension GL_GOOGLE_include_directive : require
// Traces the copies that a fragment's bin lists.
#include "stage/bins_fragment.glsl"
#include "stage/outputs.glsl"

layout(depth_greater) out float gl_FragDepth;

void main()
{
    begin();
    uvec2 pixel = uvec2(gl_FragCoord.xy);
    Nearest nearest;
    bool found = nearest_hit(pixel, nearest);
    count_steps(pixel, nearest.steps, nearest.exhausted);
    if (!found) {
        discard;
    }
    Instance i = instances[nearest.instance];
    store(shade(look_of(i), pixel_rays(i), pixel, nearest.hit));
    gl_FragDepth = nearest.depth;
}
