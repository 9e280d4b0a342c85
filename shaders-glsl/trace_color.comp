#version 450
#extension GL_GOOGLE_include_directive : require
// Traces the pixels of a batch's bins: colour, packed sRGB, and depth.
#include "include/bins.glsl"
#include "include/srgb.glsl"

void main()
{
    begin();
    Bin bin = this_bin();
    uvec2 pixel = this_pixel(bin);
    if (any(greaterThanEqual(pixel, frame.size.xy))) {
        return;
    }
    Nearest nearest;
    if (nearest_hit(bin, pixel, nearest)) {
        vec4 color = shade_nearest(pixel, nearest).color;
        keep_depth(pixel, nearest);
        pixel_words[second_word(pixel)] = pack_srgb(color);
    }
}
