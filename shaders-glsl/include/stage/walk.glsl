// Finds the nearest hit of a pixel among all copies of a hierarchy. Rays walk its boxes, nearest first.
// A walk needs no stack: a bit for each level says whether the sibling of the way's node is still to be visited.
#ifndef WALK_GLSL
#define WALK_GLSL
#include "core/placed.glsl"
#include "core/trace.glsl"

const float NEVER = 3e38; // in place of the depth at which a ray enters a box

// Returns a depth as copies are compared by. Fragments read no depths of a buffer, so theirs are in clip space.
float walk_depth_of(float t)
{
#ifdef CLIP_DEPTHS
    float depth = frame.depth_constant + frame.depth_factor / t;
#else
    float depth = depth_of(t);
#endif
    return frame.depth_sense * depth;
}

// Returns the depth at which a ray enters a node's box before depth `most`, or NEVER. `inverse`: grid steps over its
// direction.
float entry_of(WalkNode node, vec3 inverse, float most)
{
    vec3 a = (vec3(node.bounds & 0xffffu) - frame_block.eye.grid_low) * inverse;
    vec3 b = (vec3(node.bounds >> 16) - frame_block.eye.grid_high) * inverse;
    vec3 near = min(a, b);
    vec3 far = max(a, b);
    float enter = max(max(near.x, near.y), max(near.z, 0.0));
    return enter <= min(min(far.x, far.y), min(far.z, most)) ? enter : NEVER;
}

// The nearest hit of a pixel so far.
struct Nearest {
    bool found;
    uint index; // instance
    float depth; // in the unit of walk_depth_of; before the first hit a limit that grows away from the eye
    float most; // depth behind which nothing is nearer
    Hit hit; // its steps and `exhausted` are those of all searches
};

Nearest nothing_nearer_than(float depth)
{
    return Nearest(false, INNER_NODE, depth, NEVER, NO_HIT);
}

// Traces a copy. Of equal depths, the first copy wins.
void take_nearer(uint number, vec2 at, inout Nearest nearest)
{
    Instance i = walked_instance(number);
    load_shape(i);
    PixelRays rays = pixel_rays(i);
    Hit hit;
    bool hits = trace(ray_origin(rays, at), ray_direction(rays, at), rays.base, EVERYWHERE, hit);
    uint steps = nearest.hit.steps + hit.steps;
    bool exhausted = nearest.hit.exhausted || hit.exhausted;
    float t = rays.base + hit.t;
    float depth = walk_depth_of(t);
    bool first = nearest.found && depth == nearest.depth && number < nearest.index;
    if (hits && (depth < nearest.depth || first)) {
        nearest = Nearest(true, number, depth, t * (1.0 + 1e-6), hit);
    }
    nearest.hit.steps = steps;
    nearest.hit.exhausted = exhausted;
}

// Finds the nearest hit among the copies of a hierarchy. `root`: its index; `at`: position of the ray (pixel_ray.glsl).
void walk(uint root, vec2 at, inout Nearest nearest)
{
    vec3 direction = frame.dir_00 + at.x * frame.dir_x + at.y * frame.dir_y;
    vec3 inverse = frame_block.eye.grid_unit / mix(direction, vec3(1e-20), lessThan(abs(direction), vec3(1e-20)));
    if (ONE_OBJECT == 2u) {
        // The only copy is the same for all invocations.
        if (entry_of(node_at(root + 1u), inverse, NEVER) < NEVER) {
            take_nearer(node_at(root + 1u).index, at, nearest);
        }
        return;
    }
    uint leaves = node_at(root).index;
    uint k = 1u; // the current node; 0 at the end
    uint trail = 0u; // bit n: the sibling of the node n levels above is still to be visited
    for (;;) {
        uint met = INNER_NODE;
        // Invocations meet behind this loop, each with the next copy of its own pixel.
        while (met == INNER_NODE && k != 0u) {
            bool ends = k >= leaves;
            uint pair = root + (ends ? k : 2u * k);
            WalkNode first = node_at(pair);
            WalkNode second = node_at(pair + 1u);
            float to_first = entry_of(first, inverse, nearest.most);
            float to_second = entry_of(second, inverse, nearest.most);
            bool swaps = to_second < to_first;
            bool both = max(to_first, to_second) < NEVER;
            bool down = !ends && min(to_first, to_second) < NEVER;
            met = ends && to_first < NEVER ? first.index : INNER_NODE;
            uint up = uint(max(findLSB(trail), 0));
            uint next = trail == 0u ? 0u : k >> up ^ 1u;
            k = down ? 2u * k + uint(swaps) : next;
            trail = down ? trail << 1 | uint(both) : trail >> up & ~1u;
        }
        if (met == INNER_NODE) {
            break;
        }
        take_nearer(met, at, nearest);
    }
}

#endif
