// Finds the nearest hit of a pixel among the copies in the queue of its tile.
#ifndef QUEUE_GLSL
#define QUEUE_GLSL
#include "stage/tiles.glsl"
#include "core/trace.glsl"

// Returns the copies of a block that pixel `bit` of the tile may show, one bit each.
uint marks_of(uint block, uint bit)
{
    uint at = bit * QUEUE_BLOCK;
    return bitfieldExtract(queue_blocks[block].marks[at >> 5], int(at & 31u), int(QUEUE_BLOCK));
}

// Finds the nearest hit. Of equal depths, the copy that begins nearer wins, then the first one, as under a depth test of
// sorted copies. Copies that begin behind the hit, or behind the initial `depth`, which grows away from the eye, are
// left out. `bit`: number of the pixel in its tile; `at`: position of the ray (pixel_ray.glsl); `index`: instance that
// was hit. `nearest.steps` and `nearest.exhausted` are those of all searches, with or without a hit.
bool nearest_copy(QueueTile tile, uint bit, vec2 at, inout float depth, out uint index, out Hit nearest)
{
    bool found = false;
    uint steps = 0u;
    bool exhausted = false;
    uint end = tile.first + (tile.count + QUEUE_BLOCK - 1u) / QUEUE_BLOCK;
    float sense = frame.depth_sense;
    uint block = tile.first; // the next one
    uint marks = 0u;
    index = 0u;
    for (;;) {
        // Invocations meet behind this loop, each with the next copy of its own pixel.
        while (marks == 0u && block < end) {
            marks = marks_of(block, bit);
            ++block;
        }
        if (marks == 0u) {
            break;
        }
        uint n = uint(findLSB(marks));
        marks &= marks - 1u;
        QueuedCopy copy = queue_blocks[block - 1u].copies[n];
        // Without a lag: copies that follow may lag less than this one.
        if (sense * depth_of(max(copy.near, 1e-30), depth_terms()) >= depth) {
            break;
        }
        Instance i = instance_at(copy.instance);
        load_shape(i);
        PixelRays rays = pixel_rays(i);
        Hit hit;
        bool met = trace(ray_origin(rays, at), ray_direction(rays, at), rays.base, EVERYWHERE, hit);
        steps += hit.steps;
        exhausted = exhausted || hit.exhausted;
        float met_at = sense * depth_of(rays.base + hit.t, lagging_terms(i.lag));
        if (met && met_at < depth) {
            found = true;
            index = copy.instance;
            depth = met_at;
            nearest = hit;
        }
    }
    nearest.steps = steps;
    nearest.exhausted = exhausted;
    return found;
}

#endif
