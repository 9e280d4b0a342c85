#version 450
#extension GL_GOOGLE_include_directive : require
// Temporal anti-aliasing: blends a pixel with where its surface was in the last picture, clipped to the range of its
// neighbours now. `matrix`: the last clip space from this one. `first`: this frame's jitter, pixels; the weight of
// this frame; 1 to follow motion. `second`: 1 to keep the range of the neighbours.
#include "buffers.glsl"

vec3 last_at(vec2 at, ivec2 size)
{
    vec2 from = at - 0.5;
    ivec2 corner = ivec2(floor(from));
    vec2 part = from - vec2(corner);
    vec3 sum = vec3(0.0);
    for (int k = 0; k < 4; ++k) {
        ivec2 step = ivec2(k & 1, k >> 1);
        vec2 weight = mix(1.0 - part, part, vec2(step));
        sum += weight.x * weight.y * imageLoad(last_picture, clamp(corner + step, ivec2(0), size - 1)).rgb;
    }
    return sum;
}

void main()
{
    ivec2 p = ivec2(gl_GlobalInvocationID.xy);
    ivec2 size = imageSize(lit);
    if (any(greaterThanEqual(p, size))) {
        return;
    }
    // Silhouettes move with what is in front: the nearest neighbour.
    ivec2 nearest = p;
    for (int k = 0; k < 9; ++k) {
        ivec2 q = clamp(p + ivec2(k % 3, k / 3) - 1, ivec2(0), size - 1);
        nearest = texelFetch(depth, q, 0).x < texelFetch(depth, nearest, 0).x ? q : nearest;
    }
    vec2 way = texelFetch(motion, nearest, 0).xy;
    if (texelFetch(identity, nearest, 0).x == ~0u) {
        // Meshes and the sky stand still in the world.
        vec2 from = vec2(nearest) + 0.5;
        vec4 last = pushed.matrix * vec4(2.0 * from / vec2(size) - 1.0, texelFetch(depth, nearest, 0).x, 1.0);
        way = (0.5 + 0.5 * last.xy / last.w) * vec2(size) - (from - pushed.first.xy);
    }
    if (pushed.first.w == 0.0) {
        way = vec2(0.0);
    }
    vec3 now = imageLoad(lit, p).rgb;
    vec3 low = now;
    vec3 high = now;
    for (int k = 0; k < 9; ++k) {
        vec3 beside = imageLoad(lit, clamp(p + ivec2(k % 3, k / 3) - 1, ivec2(0), size - 1)).rgb;
        low = min(low, beside);
        high = max(high, beside);
    }
    vec3 last = last_at(vec2(p) + 0.5 + way, size);
    if (pushed.second.x != 0.0) {
        last = clamp(last, low, high);
    }
    imageStore(picture, p, vec4(mix(last, now, pushed.first.z), 1.0));
}
