// Finds the nearest hit of a pixel among all copies of a hierarchy. Rays walk its boxes, nearest first.
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

// Returns the depth at which a ray enters a node's box, or NEVER. `inverse`: 1 / its direction. `depth`: that of the hit
// so far; boxes behind it count as missed.
float entry_of(CasterNode node, vec3 inverse, float depth)
{
    vec3 way = node.middle - frame_block.eye.walked;
    vec3 reach = node.half_size + frame_block.eye.walk_slack;
    vec3 a = (way - reach) * inverse;
    vec3 b = (way + reach) * inverse;
    vec3 near = min(a, b);
    vec3 far = max(a, b);
    float enter = max(max(near.x, near.y), max(near.z, 0.0));
    bool meets = enter <= min(far.x, min(far.y, far.z));
    return meets && walk_depth_of(max(enter, 1e-30)) <= depth ? enter : NEVER;
}

// Finds the nearest hit. Of equal depths, the first copy wins. Hits that are not nearer than the initial `depth`, which
// grows away from the eye, are left out. `root`: index of the hierarchy's root; `at`: position of the ray
// (pixel_ray.glsl); `index`: instance that was hit. `nearest.steps` and `nearest.exhausted` are those of all searches.
bool nearest_walked(uint root, vec2 at, inout float depth, out uint index, out Hit nearest)
{
    vec3 direction = frame.dir_00 + at.x * frame.dir_x + at.y * frame.dir_y;
    vec3 inverse = 1.0 / mix(direction, vec3(1e-20), lessThan(abs(direction), vec3(1e-20)));
    uint waiting[WALK_DEPTH]; // nodes that the ray enters after the current one
    float entries[WALK_DEPTH]; // the depths at which it does
    uint count = 0u;
    uint steps = 0u;
    bool exhausted = false;
    bool found = false;
    index = INNER_NODE;
    uint node = root;
    bool is_met = entry_of(casters[root], inverse, depth) < NEVER;
    for (;;) {
        uint met = INNER_NODE;
        // Invocations meet behind this loop, each with the next copy of its own pixel.
        while (met == INNER_NODE && (is_met || count > 0u)) {
            if (!is_met) {
                --count;
                node = waiting[count];
                is_met = walk_depth_of(max(entries[count], 1e-30)) <= depth;
                continue;
            }
            met = casters[node].instance;
            is_met = false;
            if (met == INNER_NODE) {
                CasterNode left = casters[node + 1u];
                uint right = left.instance == INNER_NODE ? root + left.next : node + 2u;
                float to_left = entry_of(left, inverse, depth);
                float to_right = entry_of(casters[right], inverse, depth);
                bool swaps = to_right < to_left;
                if (max(to_left, to_right) < NEVER && count < WALK_DEPTH) {
                    waiting[count] = swaps ? node + 1u : right;
                    entries[count] = max(to_left, to_right);
                    ++count;
                }
                node = swaps ? right : node + 1u;
                is_met = min(to_left, to_right) < NEVER;
            }
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
        float met_at = walk_depth_of(rays.base + hit.t);
        if (hits && (met_at < depth || (found && met_at == depth && met < index))) {
            found = true;
            index = met;
            depth = met_at;
            nearest = hit;
        }
    }
    nearest.steps = steps;
    nearest.exhausted = exhausted;
    return found;
}

#endif
