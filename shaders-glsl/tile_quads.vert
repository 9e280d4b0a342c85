#version 450
#extension GL_GOOGLE_include_directive : require
// Vertices of a quad of pixels (tile_words.glsl) in which one copy may be visible. Its fragments search that copy like
// those of a box. Quads are points with one vertex each. Devices without points of this size draw two triangles.
#include "stage/vertex.glsl"
#include "stage/tree_varyings.glsl"
#include "stage/tile_words.glsl"
#include "stage/beam.glsl"

void main()
{
    uint at = 4u * (LARGE_POINTS != 0u ? uint(gl_VertexIndex) : uint(gl_VertexIndex) / 6u);
    uint packed = tile_words[at];
    uvec2 corner = uvec2(packed, packed >> QUAD_BITS) & ((1u << QUAD_BITS) - 1u);
    uint side = 1u << (packed >> (2u * QUAD_BITS)); // pixels
    // A draw that only warms up pipelines may read any record.
    Instance i = begin(min(tile_words[at + 1u], uint(instances.length()) - 1u));
    vec2 position = vec2(corner) + 0.5 * float(side);
    if (LARGE_POINTS == 0u) {
        uint bit = 1u << (uint(gl_VertexIndex) % 6u);
        position = vec2(corner) + float(side) * vec2((0x32u & bit) != 0u, (0x2cu & bit) != 0u);
    }
    float near = clip_depth_of(max(uintBitsToFloat(tile_words[at + 3u]), 1e-30)); // the nearest that a fragment can have
    gl_Position = vec4(position * frame.pixels.xz + frame.pixels.yw, near, 1.0);
    gl_PointSize = float(side);
    hand_over(i, frame.dir_00.w);
    vec2 span = EVERYWHERE;
    if (is_outside()) {
        PixelRays rays = pixel_rays(i);
        span = beam_span(beam_of(rays, corner, side, farthest_of(rays, i), 0.0));
    }
    hand_over_tree(span);
}
