#version 450
#extension GL_GOOGLE_include_directive : require
// Traces a fragment of a box, for `quadric`, `live`, searches of other crates, and what cells do not draw.
#include "stage/tree_varyings.glsl"
#include "core/trace.glsl"
#include "stage/outputs.glsl"

layout(depth_greater) out float gl_FragDepth;

void main()
{
    vec2 pixel = gl_FragCoord.xy - 0.5; // of the sample, where each has a ray
    load_varyings();
    load_tree_varyings();
    PixelRays rays = varying_rays();
    Hit hit = NO_HIT;
    RayStart start = FROM_EYE;
    bool found = trace(ray_origin(rays, pixel), ray_direction(rays, pixel), rays.base, start, hit);
    count_steps(pixel, hit.steps, hit.exhausted);
    if (!found) {
        discard;
    }
    gl_FragDepth = draw(varying_look(), rays, pixel, hit);
}
