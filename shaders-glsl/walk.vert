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
    uvec3 box = node_at(root + 1u).bounds;
    vec3 begin = (vec3(box & 0xffffu) - frame_block.eye.grid_low) * frame_block.eye.grid_unit;
    vec3 end = (vec3(box >> 16) - frame_block.eye.grid_high) * frame_block.eye.grid_unit;
    vec3 middle = 0.5 * (begin + end);
    vec3 half_size = 0.5 * (end - begin);
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
    walk_root = uvec2(root, instances[node_at(root + node_at(root).index).index].object);
}
