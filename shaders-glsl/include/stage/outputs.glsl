// Outputs of a fragment for a hit: depth only, its colour, or every plane.
#ifndef OUTPUTS_GLSL
#define OUTPUTS_GLSL
#if OUTPUT != OUTPUT_DEPTH
#include "core/shade.glsl"
layout(location = 0) out vec4 color;
#endif
#if OUTPUT == OUTPUT_PLANES
#include "stage/pixel_words.glsl"
layout(location = 1) out vec4 normal_distance;
layout(location = 2) out vec4 shading_normal_u;
layout(location = 3) out vec4 albedo_v;
#endif

// Adds the look-ups of a pixel, with or without a hit.
void count_steps(uvec2 pixel, uint steps, bool exhausted)
{
#if OUTPUT == OUTPUT_PLANES
    atomicAdd(pixel_words[second_word(pixel)], steps);
    if (exhausted) {
        atomicOr(pixel_words[second_word(pixel)], EXHAUSTED_BIT);
    }
#endif
}

#if OUTPUT != OUTPUT_DEPTH
void store(Shaded s)
{
    color = s.color;
#if OUTPUT == OUTPUT_PLANES
    normal_distance = vec4(s.normal, s.distance);
    shading_normal_u = vec4(s.shading_normal, s.uv.x);
    albedo_v = vec4(s.albedo, s.uv.y);
#endif
}
#endif

#endif
