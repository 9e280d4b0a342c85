#version 450
#extension GL_GOOGLE_include_directive : require
// Traces the pixels of tiles in which several copies may be visible.
#include "stage/copies.glsl"

void main()
{
    take_frame();
    take_object(pushed.object);
    take_lights();
    uint first, count;
    uvec2 pixel = this_pixel(first, count);
    if (all(lessThan(pixel, frame.size.xy))) {
        float depth = drawn_depth(pixel);
        uint index;
        Hit hit;
        bool found = nearest_copy(first, count, pixel, depth, index, hit);
        count_steps(pixel, hit);
        if (found) {
            Instance i = instances[index];
            if (ONE_OBJECT == 0u) {
                take_object(i.object.x);
            }
            Look look = look_of(i);
#if HOST_SHADING
            look.instance = index;
#endif
            store(pixel, depth, shade(look, pixel_rays(i), pixel, hit));
        }
    }
}
