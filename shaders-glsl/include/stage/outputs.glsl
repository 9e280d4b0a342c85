// Outputs of a fragment for a hit: depth only, its colour, every plane of a frame, or the planes of a list.
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
#if OUTPUT == OUTPUT_LIST
// src/shader/outputs.rs moves these to the host's locations and makes the unused ones private.
layout(location = 1) out vec4 base_color;
layout(location = 2) out vec4 world_normal;
layout(location = 3) out vec4 octahedral_normal;
layout(location = 4) out vec4 material; // roughness, metalness
layout(location = 5) out vec4 motion;   // pixels, from this frame's position to the last frame's
layout(location = 6) out uvec4 identity; // number of the object, number of the copy
#endif

// Adds the look-ups of a pixel, with or without a hit. `pixel`: of a sample, where each has a ray.
void count_steps(vec2 pixel, uint steps, bool exhausted)
{
#if OUTPUT == OUTPUT_PLANES
    uvec2 at = uvec2(pixel + 0.5);
    if (any(greaterThanEqual(at, frame.size))) {
        return; // the viewport ends beyond the target
    }
    atomicAdd(pixel_words[second_word(at)], steps);
    if (exhausted) {
        atomicOr(pixel_words[second_word(at)], EXHAUSTED_BIT);
    }
#endif
}

#if OUTPUT == OUTPUT_LIST
// Returns a unit vector as a point of the square -1..1 (Meyer et al. 2010).
vec2 octahedral(vec3 n)
{
    vec2 p = n.xy / (abs(n.x) + abs(n.y) + abs(n.z));
    vec2 sense = mix(vec2(-1.0), vec2(1.0), greaterThanEqual(p, vec2(0.0)));
    return mix((1.0 - abs(p.yx)) * sense, p, bvec2(n.z >= 0.0));
}

// Returns the way in pixels from a hit to where it was in the last frame. The hit moves along its normal by the change
// of the extension; last_copy() of src/gpu/renderer/blocks.rs makes the rows.
vec2 motion_of(PixelRays rays, uint instance, vec2 pixel, Hit hit)
{
    LastCopy before = last_copies[frame.last_copies + instance];
    vec3 p = ray_origin(rays, pixel) + hit.t * ray_direction(rays, pixel);
    // A replica is a solid of this extension, divided by the number of replicas along each axis.
    vec3 count = vec3(shape.replicas);
    vec3 way = REPLICAS == 0u ? unit(hit.normal) : unit(hit.normal / count) / count;
    vec4 at = vec4(p + before.farther * way, 1.0);
    vec3 projected = vec3(dot(before.row_x, at), dot(before.row_y, at), dot(before.row_w, at));
    // A point that was behind the eye has no position in the last frame.
    return mix(vec2(0.0), projected.xy / projected.z - pixel - before.jitter, bvec2(projected.z > 0.0));
}
#endif

#if OUTPUT == OUTPUT_DEPTH
// Returns the depth value of a hit, moved away from the eye by the bias for the slope of its tangent plane. `terms`: as
// lagging_terms() returns them.
float draw(Look look, PixelRays rays, vec2 pixel, Hit hit, vec2 terms)
{
    float t = rays.base + hit.t;
    float depth = depth_of(t, terms);
    if (SLOPE_BIAS == 0u) {
        return depth;
    }
    // The plane normal . (origin + t direction) = constant, differentiated by the pixel's position.
    vec2 across = abs(vec2(dot(hit.normal, rays.dir_x), dot(hit.normal, rays.dir_y)));
    float along = abs(dot(hit.normal, ray_direction(rays, pixel)));
    float change = abs(ORTHO != 0u ? frame.depth_factor : frame.depth_factor / t) * frame_block.depth_range;
    float slope = change * max(across.x, across.y) / max(along, 1e-30);
    float bias = min(uintBitsToFloat(SLOPE_BIAS) * slope, uintBitsToFloat(SLOPE_BIAS_LIMIT));
    return clamp(depth + frame.depth_sense * bias, 0.0, 1.0);
}
#else
// Shades and writes a hit, and returns its depth value. `terms`: as lagging_terms() returns them.
float draw(Look look, PixelRays rays, vec2 pixel, Hit hit, vec2 terms)
{
#if OUTPUT == OUTPUT_LIST
    // Before shade(): shadows read other objects in its place.
    motion = vec4(motion_of(rays, look.instance, pixel, hit), 0.0, 1.0);
#endif
    Shaded s = shade(look, rays, pixel, hit);
    color = s.color;
#if OUTPUT == OUTPUT_PLANES
    normal_distance = vec4(s.normal, s.distance);
    shading_normal_u = vec4(s.shading_normal, s.uv.x);
    albedo_v = vec4(s.albedo, s.uv.y);
#endif
#if OUTPUT == OUTPUT_LIST
    base_color = vec4(s.albedo, 1.0);
    world_normal = vec4(s.shading_normal, 1.0);
    octahedral_normal = vec4(octahedral(s.shading_normal), 0.0, 1.0);
    material = vec4(unpackUnorm2x16(appearance.material), 0.0, 1.0);
    identity = uvec4(instances[look.instance].object, look.instance - appearance.first_instance, 0u, 1u);
#endif
    return depth_of(rays.base + hit.t, terms);
}
#endif

float draw(Look look, PixelRays rays, vec2 pixel, Hit hit)
{
    return draw(look, rays, pixel, hit, depth_terms());
}

#endif
