// Finds the nearest hit of a pixel among all copies of a hierarchy. Rays try the copies that their tile lists, then
// walk the boxes of the others, nearest first.
// A walk needs no stack: a bit for each level says whether the sibling of the way's node is still to be visited.
#ifndef WALK_GLSL
#define WALK_GLSL
#include "core/trace.glsl"
#include "stage/tile_walk.glsl"

const uint MOST_TURNS = 0x7fffffffu; // of loops, which end before

// Returns a depth as copies are compared by. Fragments read no depths of a buffer, so theirs are in clip space.
float walk_depth_of(float t, vec2 terms)
{
#ifdef CLIP_DEPTHS
    float depth = terms.x + terms.y / t;
#else
    float depth = depth_of(t, terms);
#endif
    return frame.depth_sense * depth;
}

// Returns the depth at which a ray enters a node's box before depth `most`, or NEVER. `inverse`: grid steps over its
// direction.
float entry_of(WalkNode node, vec3 inverse, float most)
{
    vec3 a = (vec3(node.bounds & 0xffffu) - grid_low) * inverse;
    vec3 b = (vec3(node.bounds >> 16) - grid_high) * inverse;
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

// Returns a depth behind which no copy is nearer than a hit of a copy with this lag.
float farthest_before(float t, float lag)
{
    float part = lag * (1.0 + t * abs(frame_block.lag_depth.x / frame.depth_factor));
    return part < 0.5 ? t * (1.0 + 1e-6) / (1.0 - part) : NEVER;
}

#ifndef CLIP_DEPTHS
// The copy of a dispatch that has only one. It is loaded before invocations part: see blocks.glsl.
Instance only_copy;
#endif

// Traces a copy. Of equal depths, the first copy wins.
void take_nearer_copy(uint number, Instance i, vec2 at, inout Nearest nearest)
{
    load_shape(i);
    PixelRays rays = pixel_rays(i);
    Hit hit;
    RayStart start = FROM_EYE;
    bool hits = trace(ray_origin(rays, at), ray_direction(rays, at), rays.base, start, hit);
    uint steps = nearest.hit.steps + hit.steps;
    bool exhausted = nearest.hit.exhausted || hit.exhausted;
    float t = rays.base + hit.t;
    float depth = walk_depth_of(t, lagging_terms(i.lag));
    bool first = nearest.found && depth == nearest.depth && number < nearest.index;
    if (hits && (depth < nearest.depth || first)) {
        nearest = Nearest(true, number, depth, farthest_before(t, i.lag), hit);
    }
    nearest.hit.steps = steps;
    nearest.hit.exhausted = exhausted;
}

// Returns the next copy that a ray may meet before depth `most`, or INNER_NODE. `tile`: what is left of its walk;
// `leaves`: the first node without children.
uint next_copy(uint root, uint leaves, vec3 inverse, float most, inout TileWalk tile)
{
    uint met;
    bool more;
    for (uint turn = 0u; turn < MOST_TURNS; ++turn) {
        bool listed = tile.first.x != 0u;
        uint node = listed ? tile.first.x : tile.node;
        bool ends = node >= leaves;
        uint pair = root + (ends ? node : 2u * node);
        WalkNode first = node_at(pair);
        float to_first = entry_of(first, inverse, most);
        float to_second = entry_of(node_at(pair + 1u), inverse, most);
        bool swaps = to_second < to_first;
        bool both = max(to_first, to_second) < NEVER;
        bool down = node != 0u && !ends && min(to_first, to_second) < NEVER;
        met = ends && to_first < NEVER ? first.index : INNER_NODE;
        uint trail = tile.trail;
        uint next = next_node(node, trail);
        trail = down ? tile.trail << 1 | uint(both) : trail;
        next = down ? 2u * node + uint(swaps) : next;
        tile.trail = listed ? tile.trail : trail;
        tile.node = listed ? tile.node : next;
        tile.first = listed ? uvec4(tile.first.yzw, 0u) : tile.first;
        more = tile.first.x != 0u || (tile.node != 0u && tile.rest < most);
        if (met != INNER_NODE || !more) {
            break;
        }
    }
    return met;
}

// Finds the nearest hit among the copies of a hierarchy. `root`: its index; `at`: position of the ray (pixel_ray.glsl);
// `tile`: where its walk begins.
void walk(uint root, vec2 at, TileWalk tile, inout Nearest nearest)
{
    vec3 direction = frame.dir_00 + at.x * frame.dir_x + at.y * frame.dir_y;
    vec3 inverse = grid_unit / mix(direction, vec3(1e-20), lessThan(abs(direction), vec3(1e-20)));
#ifndef CLIP_DEPTHS
    if (ONE_OBJECT == 2u) {
        // The only copy, which compute alone walks to, is the same for all invocations.
        if (entry_of(node_at(root + 1u), inverse, NEVER) < NEVER) {
            take_nearer_copy(pushed.instance, only_copy, at, nearest);
        }
        return;
    }
#endif
    uint leaves = node_at(root).index;
    // Loops end at their end: lavapipe executes a body once more after the last invocation has left at its begin. They
    // have a test there as well, for without one SwiftShader loses invocations in loops that not all of them enter.
    uint met = next_copy(root, leaves, inverse, nearest.most, tile);
    if (met != INNER_NODE) {
        for (uint turn = 0u; turn < MOST_TURNS; ++turn) {
            take_nearer_copy(met, instance_at(met), at, nearest);
            met = next_copy(root, leaves, inverse, nearest.most, tile);
            if (met == INNER_NODE) {
                break;
            }
        }
    }
}

#endif
