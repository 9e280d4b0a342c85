#version 450
#extension GL_GOOGLE_include_directive : require
// Corners of two triangles over a tile with a queue. Points would vanish where their middle is outside of the picture.
#include "stage/tiles.glsl"
#include "core/pixel_ray.glsl"

layout(location = 0) flat out uvec2 tile_queue; // first block, number of copies

void main()
{
    load_frame(0u);
    QueueTile tile = queue_tiles[uint(gl_VertexIndex) / 6u];
    uint bit = 1u << (uint(gl_VertexIndex) % 6u);
    // Halves of the tile in which no pixel shows a copy are left out.
    uvec4 halves = uvec4(tile.place) >> TILE_HALVES + uvec4(0u, 1u, 2u, 3u) & 1u;
    uvec2 far = uvec2((0x32u & bit) != 0u, (0x2cu & bit) != 0u);
    uvec2 half_tiles = far * (1u + halves.yw) + (1u - far) * (1u - halves.xz);
    vec2 corner = vec2(corner_of(tile) + GROUP_PIXELS / 2u * half_tiles);
    float near = clip_depth_of(max(tile.near, 1e-30)); // the nearest that a fragment can have
    gl_Position = vec4(corner * frame.clip_scale + frame.clip_shift, near, 1.0);
    tile_queue = uvec2(tile.first, tile.count);
}
