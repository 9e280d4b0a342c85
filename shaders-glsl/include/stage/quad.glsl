// Quads of pixels (tile_words.glsl), drawn as points with one vertex each. Devices without points of this size draw two
// triangles with six vertices.
#ifndef QUAD_GLSL
#define QUAD_GLSL
#include "stage/tile_words.glsl"
#include "core/pixel_ray.glsl"

struct Quad {
    uvec2 corner; // pixels
    uint side;
    uint instance;
    float near; // lower bound of the copy's depth
};

Quad this_quad()
{
    uint at = 4u * (LARGE_POINTS != 0u ? uint(gl_VertexIndex) : uint(gl_VertexIndex) / 6u);
    uint packed = tile_words[at];
    uvec2 corner = uvec2(packed, packed >> QUAD_BITS) & ((1u << QUAD_BITS) - 1u);
    return Quad(corner, 1u << (packed >> (2u * QUAD_BITS)), tile_words[at + 1u], uintBitsToFloat(tile_words[at + 3u]));
}

// Sets the position of a vertex. The quad's depth is the nearest that a fragment can have.
void position_quad(Quad quad)
{
    vec2 at = vec2(quad.corner) + 0.5 * float(quad.side);
    if (LARGE_POINTS == 0u) {
        uint bit = 1u << (uint(gl_VertexIndex) % 6u);
        at = vec2(quad.corner) + float(quad.side) * vec2((0x32u & bit) != 0u, (0x2cu & bit) != 0u);
    }
    gl_Position = vec4(at * frame.pixels.xz + frame.pixels.yw, depth_of(max(quad.near, 1e-30)), 1.0);
    gl_PointSize = float(quad.side);
}

#endif
