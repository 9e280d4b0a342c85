#version 450
#extension GL_GOOGLE_include_directive : require
// Lists the copies of one range of depth in the tiles that may show them, and marks the pixels that they hide. One invocation per copy of the range.
#include "stage/crowd.glsl"

// Returns the bits of a tile that are within a rectangle of pixels; rows 0 to 3, rows 4 to 7.
uvec2 within(ivec2 tile, ivec4 pixels)
{
    ivec4 in_tile = clamp(pixels - 8 * tile.xyxy, 0, 7);
    if (any(lessThan(pixels.zw, 8 * tile)) || any(greaterThan(pixels.xy, 8 * tile + 7))) {
        return uvec2(0u);
    }
    uint row = (0xffu >> uint(7 - in_tile.z + in_tile.x)) << uint(in_tile.x);
    uvec2 bits = uvec2(row * 0x01010101u);
    uvec2 from = uvec2(in_tile.y < 4 ? 0xffffffffu << uint(8 * in_tile.y) : 0u, in_tile.y < 4 ? 0xffffffffu : 0xffffffffu << uint(8 * (in_tile.y - 4)));
    uvec2 to = uvec2(in_tile.w < 4 ? 0xffffffffu >> uint(8 * (3 - in_tile.w)) : 0xffffffffu, in_tile.w < 4 ? 0u : 0xffffffffu >> uint(8 * (7 - in_tile.w)));
    return bits & from & to;
}

// Returns the first of the eight words of a tile's cover, one for each row: the covered pixels, one bit each, and above
// them the code of the largest depth that covers one of them.
uint cover_word(ivec2 tile)
{
    return crowd.counts.w + GROUP_PIXELS * (uint(tile.y) * crowd.size.x + uint(tile.x));
}

const uint CODE_BITS = 7u; // bits of a float that the code of a depth leaves out

// Returns the pixels of a tile that hide everything at `near` or farther. Other invocations may add cover meanwhile; it
// hides no more than is proven at any time.
uvec2 hidden(ivec2 tile, uint near)
{
    uint at = cover_word(tile);
    uvec2 bits = uvec2(0u);
    for (uint k = 0u; k < GROUP_PIXELS; ++k) {
        uint word = bin_words[at + k];
        uint row = near >> CODE_BITS > word >> 8 ? word & 0xffu : 0u;
        bits[k >> 2] |= row << (8u * (k & 3u));
    }
    return bits;
}

// Adds pixels of a row to the cover. Pixels and depth change in one step.
void cover(uint at, uint bits, uint code)
{
    uint known = bin_words[at];
    while ((known & bits) != bits) {
        uint next = max(known >> 8, code) << 8 | known & 0xffu | bits;
        uint found = atomicCompSwap(bin_words[at], known, next);
        if (found == known) {
            break;
        }
        known = found;
    }
}

// Marks pixels whose rays all meet the section of a cylinder that faces the eye: a flat polygon within the solid.
void hide(Axes axes, vec2 across, vec3 piece)
{
    vec3 out_of = (axes.x * across.x + axes.y * across.y) * piece.x;
    vec3 low = axes.middle + axes.z * piece.y;
    vec3 top = axes.middle + axes.z * piece.z;
    vec3 corners[4] = vec3[4](low - out_of, low + out_of, top + out_of, top - out_of);
    vec2 flat_corners[4];
    float depth = 0.0;
    vec2 least = vec2(3e38);
    vec2 most = vec2(-3e38);
    for (uint k = 0u; k < 4u; ++k) {
        flat_corners[k] = corners[k].xy / corners[k].z;
        depth = max(depth, corners[k].z);
        least = min(least, flat_corners[k]);
        most = max(most, flat_corners[k]);
    }
    uint code = (floatBitsToUint(depth * (1.0 + 1e-5)) >> CODE_BITS) + 1u; // rounded up
    float area = 0.0;
    for (uint k = 0u; k < 4u; ++k) {
        vec2 p = flat_corners[k] - flat_corners[0];
        vec2 q = flat_corners[(k + 1u) & 3u] - flat_corners[0];
        area += p.x * q.y - p.y * q.x;
    }
    float margin = crowd.row_x.w;
    int left = max(first_pixel(least.x + margin), crowd.picture.x);
    int right = min(last_pixel(most.x - margin), crowd.picture.z);
    int first = max(first_pixel(least.y + margin), crowd.picture.y);
    int last = min(last_pixel(most.y - margin), crowd.picture.w);
    if (!(abs(area) > 0.0) || left > right) {
        return;
    }
    float sense = sign(area);
    for (int y = first; y <= last; ++y) {
        float row = float(y) + 0.5;
        float from = -3e38;
        float to = 3e38;
        for (uint k = 0u; k < 4u; ++k) {
            vec2 p = flat_corners[k];
            vec2 q = flat_corners[(k + 1u) & 3u];
            // Inside: dot(n, point) >= bound, with the margin.
            vec2 n = sense * vec2(p.y - q.y, q.x - p.x);
            float bound = n.x * p.x + n.y * (p.y - row) + margin * (abs(n.x) + abs(n.y));
            float place = bound / n.x;
            bool steep = abs(n.x) > 1e-9 * abs(n.y);
            from = steep && n.x > 0.0 ? max(from, place) : from;
            to = steep && n.x < 0.0 ? min(to, place) : to;
            to = !steep && bound > 0.0 ? -3e38 : to;
        }
        int x0 = max(first_pixel(from), left);
        int x1 = min(last_pixel(to), right);
        for (int x = x0 >> 3; x <= x1 >> 3 && x0 <= x1; ++x) {
            uint low_bit = uint(clamp(x0 - 8 * x, 0, 7));
            uint high_bit = uint(clamp(x1 - 8 * x, 0, 7));
            uint bits = (0xffu >> (7u - high_bit + low_bit)) << low_bit;
            cover(cover_word(ivec2(x, y >> 3)) + uint(y & 7), bits, code);
        }
    }
}

void main()
{
    uint n = invocation();
    if (n >= count_of(RANGES + 4u * pushed.bin)) {
        return;
    }
    uint visible = bin_words[crowd.copies.y + bin_words[head_word(RANGE_FIRSTS + pushed.bin)] + n];
    uint at = crowd.copies.x + VISIBLE_WORDS * visible;
    uint copy = bin_words[at];
    uint near_word = bin_words[at + 1u];
    float near = uintBitsToFloat(near_word);
    uvec2 corners = uvec2(bin_words[at + 2u], bin_words[at + 3u]);
    ivec4 pixels = ivec4(corners.x & 0xffffu, corners.x >> 16, corners.y & 0xffffu, corners.y >> 16);
    uint of = bin_words[at + 4u];
    vec4 shape = crowd.objects_of[of].shape;
    uvec4 pieces = crowd.objects_of[of].pieces;
    uvec4 numbers = crowd.objects_of[of].copies;
    uint number = numbers.z + copy - numbers.x;
    Axes axes = axes_of(copy, shape.xy);
    bool whole = near > 0.0;

    // The rectangles of the cylinders around the solid; one for a copy of few rows.
    ivec4 rectangles[CROWD_PIECES];
    uint count = 1u;
    rectangles[0] = pixels;
    if (whole && pixels.w - pixels.y >= 6) {
        count = pieces.y;
        for (uint k = 0u; k < count; ++k) {
            ivec4 of_piece = pixels_of(axes, crowd.objects_of[of].outer[k].xyz);
            rectangles[k] = ivec4(max(of_piece.xy, pixels.xy), min(of_piece.zw, pixels.zw));
        }
    }
    bool shows = false;
    for (int y = pixels.y >> 3; y <= pixels.w >> 3; ++y) {
        for (int x = pixels.x >> 3; x <= pixels.z >> 3; ++x) {
            ivec2 tile = ivec2(x, y);
            uvec2 bits = uvec2(0u);
            for (uint k = 0u; k < count; ++k) {
                bits |= within(tile, rectangles[k]);
            }
            bits &= ~hidden(tile, near_word);
            if ((bits.x | bits.y) == 0u) {
                continue;
            }
            shows = true;
            uint entry = add_to(ENTRIES, crowd.counts.y);
            if (entry < crowd.counts.y) {
                uint list = pieces.x * tile_count() + uint(y) * crowd.size.x + uint(x);
                uint to = crowd.copies.w + ENTRY_WORDS * entry;
                bin_words[to] = list;
                bin_words[to + 1u] = number;
                bin_words[to + 2u] = near_word;
                bin_words[to + 3u] = bits.x;
                bin_words[to + 4u] = bits.y;
                bin_words[to + 5u] = atomicAdd(bin_words[crowd.lists.x + list], 1u);
                atomicMax(bin_words[crowd.lists.y + list], ~near_word);
                atomicOr(bin_words[crowd.lists.z + 2u * list], bits.x);
                atomicOr(bin_words[crowd.lists.z + 2u * list + 1u], bits.y);
            }
        }
    }
    if (!shows) {
        return;
    }
    uint place = add_to(LISTED, 0xffffffffu);
    bin_words[crowd.copies.z + place] = visible;
    // The queue of all copies, for an overflow.
    uint to = queue_word(crowd.tiles.y, place);
    tile_words[to] = number;
    tile_words[to + 1u] = near_word;
    if (whole) {
        // The eye's direction about the axis, in object space.
        vec3 eye = -rotate(conjugate(rotation_of(copy)), vec3(from_eye(copy))) / scale_of(copy);
        vec2 towards = eye.xy - shape.xy;
        float away = length(towards);
        vec2 across = away > 0.0 ? vec2(-towards.y, towards.x) / away : vec2(1.0, 0.0);
        for (uint k = 0u; k < pieces.z; ++k) {
            hide(axes, across, crowd.objects_of[of].inner[k].xyz);
        }
    }
}
