#version 450
#extension GL_GOOGLE_include_directive : require
// Traces the pixels of tiles of the picture: the nearest copy of a hierarchy.
#define SINGLE
#include "stage/stores.glsl"
#include "stage/walk.glsl"

void main()
{
    load_frame(pushed.object);
    uint number = pushed.first + gl_WorkGroupID.x;
    uvec2 tile = uvec2(number % pushed.count, number / pushed.count);
    uvec2 pixel = GROUP_PIXELS * tile + gl_LocalInvocationID.xy;
    if (all(lessThan(pixel, frame.size))) {
        float depth = drawn_depth(pixel);
        uint index;
        Hit hit;
        bool found = nearest_walked(pushed.heads, vec2(pixel), depth, index, hit);
        count_steps(pixel, hit);
        if (found) {
            Instance i = placed(instances[index]);
            load(i);
            store(pixel, depth, shade(look_of(i, index), pixel_rays(i), pixel, hit));
        }
    }
}
