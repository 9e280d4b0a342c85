#version 450
#extension GL_GOOGLE_include_directive : require
// Traces the pixels of a batch's bins: every plane.
#include "include/bins.glsl"
#include "include/pixel_words.glsl"

layout(set = 2, binding = 2, rgba32f) uniform writeonly image2D color;
layout(set = 2, binding = 3, rgba32f) uniform writeonly image2D normal_distance;
layout(set = 2, binding = 4, rgba32f) uniform writeonly image2D shading_normal_u;
layout(set = 2, binding = 5, rgba32f) uniform writeonly image2D albedo_v;

void main()
{
    Bin bin = this_bin();
    uvec2 pixel = this_pixel(bin);
    if (any(greaterThanEqual(pixel, frame.size.xy))) {
        return;
    }
    Nearest nearest;
    bool found = nearest_hit(bin, pixel, uintBitsToFloat(pixel_words[depth_word(pixel)]), nearest);
    pixel_words[second_word(pixel)] = (pixel_words[second_word(pixel)] + nearest.steps) | (nearest.exhausted ? EXHAUSTED_BIT : 0u);
    if (found) {
        Shaded s = shade(batch_instance(nearest.instance), nearest.rays, pixel, nearest.hit);
        pixel_words[depth_word(pixel)] = floatBitsToUint(nearest.depth);
        imageStore(color, ivec2(pixel), s.color);
        imageStore(normal_distance, ivec2(pixel), vec4(s.normal, s.distance));
        imageStore(shading_normal_u, ivec2(pixel), vec4(s.shading_normal, s.uv.x));
        imageStore(albedo_v, ivec2(pixel), vec4(s.albedo, s.uv.y));
    }
}
