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
        Nearest nearest = nothing_nearer_than(drawn_depth(pixel));
        walk(pushed.heads, vec2(pixel), nearest);
        count_steps(pixel, nearest.hit);
        if (nearest.found) {
            Instance i = walked_instance(nearest.index);
            load(i);
            store(pixel, nearest.depth, shade(look_of(i, nearest.index), pixel_rays(i), pixel, nearest.hit));
        }
    }
}
