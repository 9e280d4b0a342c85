#version 450
#extension GL_GOOGLE_include_directive : require
// Corners of two triangles over a tile of a crowd (crowd_queues.comp). Points would vanish where their middle is outside
// of the picture.
#define VARYING out
#include "stage/queue_varyings.glsl"
#include "stage/tile_words.glsl"
#include "core/pixel_ray.glsl"

void main()
{
    take_frame();
    uint at = 4u * (uint(gl_VertexIndex) / 6u);
    uint bit = 1u << (uint(gl_VertexIndex) % 6u);
    uint corner_word = tile_words[at];
    vec2 corner = vec2(corner_word & 0xffffu, corner_word >> 16);
    corner += float(GROUP_PIXELS) * vec2((0x32u & bit) != 0u, (0x2cu & bit) != 0u);
    float near = depth_of(max(uintBitsToFloat(tile_words[at + 3u]), 1e-30)); // the nearest that a fragment can have
    gl_Position = vec4(corner * frame.pixels.xz + frame.pixels.yw, near, 1.0);
    if (VIEWS > 1u && VIEW_INDEX != frame_block.view.x) {
        gl_Position = vec4(1e6, 1e6, 2.0, 1.0);
    }
    tile_queue = uvec2(tile_words[at + 1u], tile_words[at + 2u]);
}
