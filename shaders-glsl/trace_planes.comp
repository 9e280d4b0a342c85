#version 450
#extension GL_GOOGLE_include_directive : require
// Traces the pixels of a batch's bins: every plane.
#include "include/bins.glsl"

layout(set = 2, binding = 2, rgba32f) uniform writeonly image2D color;
layout(set = 2, binding = 3, rgba32f) uniform writeonly image2D normal_distance;
layout(set = 2, binding = 4, rgba32f) uniform writeonly image2D shading_normal_u;
layout(set = 2, binding = 5, rgba32f) uniform writeonly image2D albedo_v;

void main()
{
    begin();
    Bin bin = this_bin();
    uvec2 pixel = this_pixel(bin);
    if (any(greaterThanEqual(pixel, frame.size.xy))) {
        return;
    }
    Nearest nearest;
    bool found = nearest_hit(bin, pixel, nearest);
    pixel_words[second_word(pixel)] = (pixel_words[second_word(pixel)] + nearest.steps) | (nearest.exhausted ? EXHAUSTED_BIT : 0u);
    if (found) {
        Shaded s = shade_nearest(pixel, nearest);
        keep_depth(pixel, nearest);
        imageStore(color, ivec2(pixel), s.color);
        imageStore(normal_distance, ivec2(pixel), vec4(s.normal, s.distance));
        imageStore(shading_normal_u, ivec2(pixel), vec4(s.shading_normal, s.uv.x));
        imageStore(albedo_v, ivec2(pixel), vec4(s.albedo, s.uv.y));
    }
}
