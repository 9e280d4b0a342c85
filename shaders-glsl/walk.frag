#version 450
#extension GL_GOOGLE_include_directive : require
// Traces a fragment: the nearest copy of a hierarchy.
#define SINGLE
#define CLIP_DEPTHS
#include "core/look.glsl"
#include "stage/walk.glsl"
#include "stage/outputs.glsl"

layout(location = 0) flat in uvec2 walk_root; // index of the root, and of an object

layout(depth_greater) out float gl_FragDepth;

void main()
{
    vec2 pixel = gl_FragCoord.xy - 0.5; // of the sample, where each has a ray
    load_frame(walk_root.y);
    Nearest nearest = nothing_nearer_than(2.0); // behind everything
    walk(walk_root.x, pixel, nearest);
    count_steps(pixel, nearest.hit.steps, nearest.hit.exhausted);
    if (!nearest.found) {
        discard;
    }
    Instance i = walked_instance(nearest.index);
    load(i);
    gl_FragDepth = draw(look_of(i, nearest.index), pixel_rays(i), pixel, nearest.hit);
}
