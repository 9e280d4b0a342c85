#version 450
#extension GL_GOOGLE_include_directive : require
// Traces the pixels of tiles in which several copies may be visible.
#include "stage/copies.glsl"

void main()
{
    take_frame();
    take_solid(pushed.solid);
    take_lights();
    uint first, count;
    uvec2 pixel = this_pixel(first, count);
    if (all(lessThan(pixel, frame.size.xy))) {
        Nearest nearest;
        nearest.depth = drawn_depth(pixel);
        nearest.steps = 0u;
        nearest.exhausted = false;
        bool found = nearest_copy(first, count, pixel, nearest);
        count_steps(pixel, nearest);
        if (found) {
            keep_depth(pixel, nearest);
            Instance i = instances[nearest.instance];
            if (ONE_SOLID == 0u) {
                take_solid(i.solid.x);
            }
            store(pixel, shade(look_of(i), pixel_rays(i), pixel, nearest.hit));
        }
    }
}
