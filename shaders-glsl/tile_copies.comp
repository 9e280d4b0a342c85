#version 450
#extension GL_GOOGLE_include_directive : require
// Traces the pixels of tiles in which several copies may be visible.
#include "stage/stores.glsl"
#include "stage/queue.glsl"

// Returns the pixel of this invocation, the first word of its queue and the number of copies in it.
uvec2 this_pixel(out uint first, out uint count)
{
    if (OF_CROWD) {
        uint group = gl_WorkGroupID.x + MOST_GROUPS * gl_WorkGroupID.y;
        uint record = 64u * group + gl_LocalInvocationIndex;
        uint word = pushed.first + 3u * record;
        uint place = record < bin_words[pushed.heads] ? tile_words[word] : 0xffffffffu;
        first = tile_words[word + 1u];
        count = tile_words[word + 2u];
        return uvec2(place & 0xffffu, place >> 16);
    }
    uint at = 4u * (pushed.first + gl_WorkGroupID.x);
    uint position = tile_words[at] + (gl_LocalInvocationID.x | gl_LocalInvocationID.y << 16);
    first = tile_words[at + 1u];
    count = tile_words[at + 2u];
    if (count == TILE_SPLIT) {
        at = first + 3u * gl_LocalInvocationIndex;
        position = tile_words[at];
        first += tile_words[at + 1u];
        count = tile_words[at + 2u];
    }
    return uvec2(position & 0xffffu, position >> 16);
}

void main()
{
    take_frame();
    take_object(pushed.object);
    take_lights();
    uint first, count;
    uvec2 pixel = this_pixel(first, count);
    if (all(lessThan(pixel, frame.size.xy))) {
        float depth = drawn_depth(pixel);
        uint index;
        Hit hit;
        bool found = nearest_copy(first, count, bit_of(pixel), vec2(pixel), depth, index, hit);
        count_steps(pixel, hit);
        if (found) {
            Instance i = instances[index];
            if (ONE_OBJECT == 0u) {
                take_object(i.object.x);
            }
            Look look = look_of(i);
#if HOST_SHADING
            look.instance = index;
#endif
            store(pixel, depth, shade(look, pixel_rays(i), pixel, hit));
        }
    }
}
