// Finds the nearest hit of a pixel among all copies of a hierarchy. Rays walk its boxes, nearest first.
//
// Nodes are in the order of a heap: the children of node k are 2 k and 2 k + 1, and nodes without children are on one
// level. Node 0 has the index of the first of them. A walk needs no stack: a bit for each level says whether the sibling
// of the way's node is still to be visited.
#ifndef WALK_GLSL
#define WALK_GLSL
#include "core/placed.glsl"
#include "core/replicas.glsl"

const float NEVER = 3e38; // in place of the depth at which a ray enters a box

// Returns a depth in the unit of nearest_walked. Fragments read no depths of a buffer, so theirs are in clip space.
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

// Finds the nearest hit. Of equal depths, the first copy wins. Hits that are not nearer than the initial `depth`, which
// grows away from the eye, are left out. `root`: index of the hierarchy; `at`: position of the ray (pixel_ray.glsl);
// `index`: instance that was hit. `nearest.steps` and `nearest.exhausted` are those of all searches.
bool nearest_walked(uint root, vec2 at, inout float depth, out uint index, out Hit nearest)
{
    vec3 direction = frame.dir_00 + at.x * frame.dir_x + at.y * frame.dir_y;
    vec3 inverse = frame_block.eye.grid_unit / mix(direction, vec3(1e-20), lessThan(abs(direction), vec3(1e-20)));
    uint leaves = walk_nodes[root].index;
    uint k = 1u; // the current node; 0 at the end
    uint trail = 0u; // bit n: the sibling of the node n levels above is still to be visited
    float most = NEVER; // depth of the nearest hit
    uint steps = 0u;
    bool exhausted = false;
    bool found = false;
    index = INNER_NODE;
    for (;;) {
        uint met = INNER_NODE;
        // Invocations meet behind this loop, each with the next copy of its own pixel.
        while (met == INNER_NODE && k != 0u) {
            bool ends = k >= leaves;
            uint pair = root + (ends ? k : 2u * k);
            WalkNode first = walk_nodes[pair];
            WalkNode second = walk_nodes[pair + 1u];
            float to_first = entry_of(first, inverse, most);
            float to_second = entry_of(second, inverse, most);
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
        Instance i = placed(instances[met]);
        load_shape(i);
        PixelRays rays = pixel_rays(i);
        Hit hit;
        bool hits = trace(ray_origin(rays, at), ray_direction(rays, at), rays.base, EVERYWHERE, hit);
        steps += hit.steps;
        exhausted = exhausted || hit.exhausted;
        float t = rays.base + hit.t;
        float met_at = walk_depth_of(t);
        if (hits && (met_at < depth || (found && met_at == depth && met < index))) {
            found = true;
            index = met;
            depth = met_at;
            most = t * (1.0 + 1e-6);
            nearest = hit;
        }
    }
    nearest.steps = steps;
    nearest.exhausted = exhausted;
    return found;
}

#endif
