#version 450
#extension GL_GOOGLE_include_directive : require
// The floor of shape boxes: a ray hits where it enters the solid's bounding cylinder.
#include "stage/box_fragment.glsl"
#include "stage/outputs.glsl"
#include "entry.glsl"

layout(depth_greater) out float gl_FragDepth;

void main()
{
    uvec2 pixel = uvec2(gl_FragCoord.xy);
    take_over();
    take_over_box();
    PixelRays rays = varying_rays();
    Hit hit;
    bool found = entry_hit(rays, pixel, hit);
    count_steps(pixel, hit.steps, hit.exhausted);
    // The vertices hand patches over, and fragments must take what they are handed: without any nothing is hit.
    if (!found || box_patches.z == 0u) {
        discard;
    }
    store(shade(varying_look(), rays, pixel, hit));
    gl_FragDepth = depth_of(rays.base + hit.t);
}
