// Squares of pixels (bin_words.glsl) as points, each a vertex; where the device has no points of this size, as two
// triangles of six vertices.
#ifndef SQUARE_GLSL
#define SQUARE_GLSL
#include "stage/bin_words.glsl"
#include "core/pixel_ray.glsl"

struct Square {
    uvec2 corner; // in pixels
    uint side;
    uvec3 words; // what its record holds besides
};

Square this_square()
{
    uint at = 4u * (LARGE_POINTS != 0u ? uint(gl_VertexIndex) : uint(gl_VertexIndex) / 6u);
    uint place = bin_words[at];
    uvec2 corner = uvec2(place, place >> SQUARE_BITS) & ((1u << SQUARE_BITS) - 1u);
    return Square(corner, 1u << (place >> (2u * SQUARE_BITS)), uvec3(bin_words[at + 1u], bin_words[at + 2u], bin_words[at + 3u]));
}

// After the blocks were taken over. No fragment's depth is nearer than the record's last word says.
void place_square(Square square)
{
    vec2 at = vec2(square.corner) + 0.5 * float(square.side);
    if (LARGE_POINTS == 0u) {
        uint bit = 1u << (uint(gl_VertexIndex) % 6u);
        at = vec2(square.corner) + float(square.side) * vec2((0x32u & bit) != 0u, (0x2cu & bit) != 0u);
    }
    float depth = depth_of(max(uintBitsToFloat(square.words.z), 1e-30));
    gl_Position = vec4(at * frame.pixels.xz + frame.pixels.yw, depth, 1.0);
    gl_PointSize = float(square.side);
}

#endif
