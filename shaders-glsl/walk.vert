#version 450
#extension GL_GOOGLE_include_directive : require
// Corners of two triangles over the pixels that may show a copy of a hierarchy.
#include "core/pixel_ray.glsl"

layout(location = 0) flat out uvec2 walk_root; // index of the root, and of an object

void main()
{
    load_frame(0u);
    uint root = uint(gl_VertexIndex) / 6u;
    uint bit = 1u << (uint(gl_VertexIndex) % 6u);
    vec3 middle = casters[root].middle - frame_block.eye.walked;
    vec3 half_size = casters[root].half_size + frame_block.eye.walk_slack;
    float near = dot(middle, frame.forward) - dot(half_size, abs(frame.forward));
    vec2 low = vec2(-1.0), high = vec2(1.0);
    if (near > 0.0) {
        vec2 first = vec2(1e30), last = vec2(-1e30);
        for (uint corner = 0u; corner < 8u; ++corner) {
            vec3 p = middle + half_size * (2.0 * vec3(uvec3(corner) >> uvec3(0u, 1u, 2u) & 1u) - 1.0);
            vec2 at = vec2(dot(frame.clip_x, p), dot(frame.clip_y, p)) / dot(frame.forward, p);
            first = min(first, at);
            last = max(last, at);
        }
        // A pixel is more than the roundings of a far view.
        low = clamp(first - abs(frame.clip_scale), low, high);
        high = clamp(last + abs(frame.clip_scale), low, high);
    }
    vec2 corner = mix(low, high, bvec2((0x32u & bit) != 0u, (0x2cu & bit) != 0u));
    float depth = clip_depth_of(max(near * (1.0 - 1e-5), 1e-30)); // the nearest that a fragment can have
    gl_Position = vec4(corner, depth, 1.0);
    uint first = root;
    while (casters[first].instance == INNER_NODE) {
        ++first;
    }
    walk_root = uvec2(root, instances[casters[first].instance].object);
}
