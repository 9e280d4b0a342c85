#version 450
#extension GL_GOOGLE_include_directive : require
// Traces the pixels of a batch's bins, of its rectangle or of the tiles that beams have listed.
#include "stage/bins.glsl"
#include "stage/stores.glsl"

void main()
{
    begin();
    Bin bin = this_bin();
    uvec2 pixel = this_pixel(bin);
    if (all(lessThan(pixel, frame.size.xy))) {
        Nearest nearest;
        bool found = nearest_hit(bin, pixel, nearest);
        count_steps(pixel, nearest);
        if (found) {
            keep_depth(pixel, nearest);
            store(pixel, shade_nearest(pixel, nearest));
        }
    }
}
