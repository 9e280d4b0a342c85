#version 450
#extension GL_GOOGLE_include_directive : require
// Vertices of a square of pixels in which one copy may be visible. Its fragments search that copy like those of a box.
// Squares are points with one vertex each. Devices without points of this size draw two triangles.
#include "stage/vertex.glsl"
#include "stage/tree_varyings.glsl"
#include "stage/tiles.glsl"
#include "stage/beam.glsl"

void main()
{
    CopyTile tile = copy_tiles[LARGE_POINTS != 0u ? uint(gl_VertexIndex) : uint(gl_VertexIndex) / 6u];
    uvec2 corner = square_corner(tile.square);
    uint side = 1u << (tile.square >> (2u * QUAD_BITS)); // pixels
    Instance i = begin(tile.instance);
    vec2 position = vec2(corner) + 0.5 * float(side);
    if (LARGE_POINTS == 0u) {
        uint bit = 1u << (uint(gl_VertexIndex) % 6u);
        position = vec2(corner) + float(side) * vec2((0x32u & bit) != 0u, (0x2cu & bit) != 0u);
    }
    float near = clip_depth_of(max(tile.near, 1e-30)); // the nearest that a fragment can have
    gl_Position = vec4(position * frame.clip_scale + frame.clip_shift, near, 1.0);
    gl_PointSize = float(side);
    hand_over(i, frame.pixel_size);
    vec2 span = EVERYWHERE;
    if (is_outside()) {
        PixelRays rays = pixel_rays(i);
        span = beam_span(beam_of(rays, corner, side, farthest_of(rays, i), 0.0));
    }
    hand_over_tree(span);
}
