#version 450
#extension GL_GOOGLE_include_directive : require
// Traces a fragment of a tile: the nearest of the copies in its queue.
#define SINGLE
#define CLIP_DEPTHS
#include "stage/queue.glsl"
#include "stage/outputs.glsl"

layout(location = 0) flat in uvec2 tile_queue; // first block, number of copies

layout(depth_greater) out float gl_FragDepth;

void main()
{
    vec2 pixel = gl_FragCoord.xy - 0.5; // of the sample, where each has a ray
    load_frame(instances[queue_blocks[tile_queue.x].copies[0].instance].object);
    float depth = 2.0; // behind everything
    uint index;
    Hit hit;
    QueueTile tile = QueueTile(0u, tile_queue.x, tile_queue.y, 0.0);
    bool found = nearest_copy(tile, bit_of(uvec2(gl_FragCoord.xy)), pixel, depth, index, hit);
    count_steps(pixel, hit.steps, hit.exhausted);
    if (!found) {
        discard;
    }
    Instance i = instance_at(index);
    load(i);
    draw(look_of(i, index), pixel_rays(i), pixel, hit);
    gl_FragDepth = buffer_depth_of(clamp(frame.depth_sense * depth, 0.0, 1.0));
}
