#version 450
#extension GL_GOOGLE_include_directive : require
// Traces a fragment: the nearest copy of a hierarchy.
#define SINGLE
#define CLIP_DEPTHS
#include "stage/walk.glsl"
#include "stage/outputs.glsl"

layout(location = 0) flat in uvec2 walk_root; // index of the root, and of an object

layout(depth_greater) out float gl_FragDepth;

void main()
{
    vec2 pixel = gl_FragCoord.xy - 0.5; // of the sample, where each has a ray
    load_frame(walk_root.y);
    float depth = 2.0; // behind everything
    uint index;
    Hit hit;
    bool found = nearest_walked(walk_root.x, pixel, depth, index, hit);
    count_steps(pixel, hit.steps, hit.exhausted);
    if (!found) {
        discard;
    }
    Instance i = placed(instances[index]);
    load(i);
    draw(look_of(i, index), pixel_rays(i), pixel, hit);
    gl_FragDepth = buffer_depth_of(clamp(frame.depth_sense * depth, 0.0, 1.0));
}
