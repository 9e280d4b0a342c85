// Outputs of a compute invocation for a hit: its colour in packed sRGB, or every plane.
#ifndef STORES_GLSL
#define STORES_GLSL
#include "stage/nearest.glsl"
#include "core/shade.glsl"
#include "stage/srgb.glsl"
#if OUTPUT == OUTPUT_PLANES
layout(set = 2, binding = 2, rgba32f) uniform writeonly image2D color;
layout(set = 2, binding = 3, rgba32f) uniform writeonly image2D normal_distance;
layout(set = 2, binding = 4, rgba32f) uniform writeonly image2D shading_normal_u;
layout(set = 2, binding = 5, rgba32f) uniform writeonly image2D albedo_v;
#endif

// Adds the look-ups of a pixel, with or without a hit.
void count_steps(uvec2 pixel, Nearest nearest)
{
#if OUTPUT == OUTPUT_PLANES
    uint word = pixel_words[second_word(pixel)] + nearest.steps;
    pixel_words[second_word(pixel)] = word | (nearest.exhausted ? EXHAUSTED_BIT : 0u);
#endif
}

void store(uvec2 pixel, Shaded s)
{
#if OUTPUT == OUTPUT_PLANES
    imageStore(color, ivec2(pixel), s.color);
    imageStore(normal_distance, ivec2(pixel), vec4(s.normal, s.distance));
    imageStore(shading_normal_u, ivec2(pixel), vec4(s.shading_normal, s.uv.x));
    imageStore(albedo_v, ivec2(pixel), vec4(s.albedo, s.uv.y));
#else
    pixel_words[second_word(pixel)] = pack_srgb(s.color);
#endif
}

#endif
