#version 450
#extension GL_GOOGLE_include_directive : require
// Traces the pixels of tiles in which several copies may be visible.
#include "stage/stores.glsl"
#include "stage/queue.glsl"

// Returns the pixel of this invocation, the first word of its queue and the number of copies in it.
uvec2 this_pixel(out uint first, out uint count)
{
    uint at = 4u * (pushed.first + gl_WorkGroupID.x);
    first = tile_words[at + 1u];
    count = tile_words[at + 2u];
    if (count != TILE_SPLIT) {
        return tile_corner_of(tile_words[at]) + gl_LocalInvocationID.xy;
    }
    uint word = first + 3u * gl_LocalInvocationIndex;
    first += tile_words[word + 1u];
    count = tile_words[word + 2u];
    return uvec2(tile_words[word] & 0xffffu, tile_words[word] >> 16);
}

void main()
{
    take_frame();
    take_only_object(pushed.object);
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
            take_one_of_objects(i);
            store(pixel, depth, shade(look_of(i, index), pixel_rays(i), pixel, hit));
        }
    }
}
