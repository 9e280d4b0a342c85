#version 450
#extension GL_GOOGLE_include_directive : require
// Traces the pixels of tiles in which several copies may be visible.
#include "stage/stores.glsl"
#include "stage/queue.glsl"

// Returns the tile of this invocation, and its pixel.
QueueTile this_tile(out uvec2 pixel)
{
    if (pushed.gathered == 0u) {
        QueueTile tile = queue_tiles[pushed.first + gl_WorkGroupID.x];
        pixel = corner_of(tile) + gl_LocalInvocationID.xy;
        return tile;
    }
    const uint PIXELS = GROUP_PIXELS * GROUP_PIXELS;
    GatheredPixel one = gathered_pixels[pushed.first + PIXELS * gl_WorkGroupID.x + gl_LocalInvocationIndex];
    pixel = uvec2(one.position & 0xffffu, one.position >> 16);
    return queue_tiles[one.tile];
}

void main()
{
    load_frame(pushed.object);
    uvec2 pixel;
    QueueTile tile = this_tile(pixel);
    if (all(lessThan(pixel, frame.size))) {
        float depth = drawn_depth(pixel);
        uint index;
        Hit hit;
        bool found = nearest_copy(tile, bit_of(pixel), vec2(pixel), depth, index, hit);
        count_steps(pixel, hit);
        if (found) {
            Instance i = instance_at(index);
            load(i);
            store(pixel, depth, shade(look_of(i, index), pixel_rays(i), pixel, hit));
        }
    }
}
