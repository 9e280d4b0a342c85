#version 450
#extension GL_GOOGLE_include_directive : require
// Intersects a fragment's ray with the patches of its cell.
#define SINGLE
#define UNSHADOWED
// On lavapipe 22 a cut solid takes 3.7 times as long with tables of its own, and 1.8 times by a view of the buffer.
#define STORED_TABLES
#include "search/cell.glsl"
#include "stage/outputs.glsl"

layout(depth_greater) out float gl_FragDepth;

void main()
{
    vec2 pixel = gl_FragCoord.xy - 0.5; // of the sample, where each has a ray
    Hit hit;
    bool found = trace_cell(pixel, hit);
    count_steps(pixel, hit.steps, hit.exhausted);
    if (!found) {
        discard;
    }
    float depth = draw(varying_look(), varying_rays(), pixel, hit);
    // The triangle is never behind the surface that it wraps, except by rounding.
    float sense = ray_dir_00.w;
    gl_FragDepth = sense * max(sense * depth, sense * gl_FragCoord.z);
}
