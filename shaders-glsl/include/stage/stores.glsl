// Outputs of a compute invocation for a pixel: depth, and colour in packed sRGB or every plane.
#ifndef STORES_GLSL
#define STORES_GLSL
#include "stage/compute.glsl"
#include "stage/pixel_words.glsl"
#include "core/shade.glsl"
#include "core/trace.glsl"

#if OUTPUT == OUTPUT_PLANES
layout(set = 2, binding = 2, rgba32f) uniform writeonly image2D color;
layout(set = 2, binding = 3, rgba32f) uniform writeonly image2D normal_distance;
layout(set = 2, binding = 4, rgba32f) uniform writeonly image2D shading_normal_u;
layout(set = 2, binding = 5, rgba32f) uniform writeonly image2D albedo_v;
#endif

// Returns the depth limit: a hit must be nearer.
float drawn_depth(uvec2 pixel)
{
    return DEPTHS != 0u ? uintBitsToFloat(pixel_words[depth_word(pixel)]) : 1.0;
}

// Adds the look-ups of a pixel, with or without a hit.
void count_steps(uvec2 pixel, Hit hit)
{
#if OUTPUT == OUTPUT_PLANES
    uint word = pixel_words[second_word(pixel)] + hit.steps;
    pixel_words[second_word(pixel)] = word | (hit.exhausted ? EXHAUSTED_BIT : 0u);
#endif
}

// Converts linear light to sRGB (IEC 61966-2-1), packed into 8 bits per channel.
uint pack_srgb(vec4 linear)
{
    vec3 c = clamp(linear.rgb, 0.0, 1.0);
    c = mix(1.055 * pow(c, vec3(1.0 / 2.4)) - 0.055, 12.92 * c, vec3(lessThanEqual(c, vec3(0.0031308))));
    return packUnorm4x8(vec4(c, clamp(linear.a, 0.0, 1.0)));
}

void store(uvec2 pixel, float depth, Shaded s)
{
    if (DEPTHS != 0u) {
        pixel_words[depth_word(pixel)] = floatBitsToUint(depth);
    }
#if OUTPUT == OUTPUT_PLANES
    imageStore(color, ivec2(pixel), s.color);
    imageStore(normal_distance, ivec2(pixel), vec4(s.normal, s.distance));
    imageStore(shading_normal_u, ivec2(pixel), vec4(s.shading_normal, s.uv.x));
    imageStore(albedo_v, ivec2(pixel), vec4(s.albedo, s.uv.y));
#else
    pixel_words[second_word(pixel)] = pack_srgb(s.color);
#endif
}

// Stores a hit of a copy that is nearer than what is drawn. Without a hit it counts the look-ups alone.
void store_nearer(uvec2 pixel, Look look, PixelRays rays, float lag, bool found, Hit hit)
{
    float depth = depth_of(rays.base + hit.t, lagging_terms(lag));
    count_steps(pixel, hit);
    if (found && (DEPTHS == 0u || depth < drawn_depth(pixel))) {
        store(pixel, depth, shade(look, rays, pixel, hit));
    }
}

#endif
