// The parts of a light that a point sees, by rays towards the light that are traced against every solid of the scene.
#ifndef SHADOW_GLSL
#define SHADOW_GLSL
#include "core/pixel_ray.glsl"
#include "core/trace.glsl"

// Rays per light: one, or several in a spiral over its disc (Vogel 1979) that each pixel rotates by its own angle. Ray
// `k` has the bit `k % LIGHT_RAYS`. The last ray leads to the middle, those before it to the rim.
const uint LIGHT_RAYS = SHADOW == SHADOW_SOFT ? 16u : 1u;
const uint ALL_RAYS = SHADOW == SHADOW_SOFT ? 0xffffu : 1u;
const uint SPIRAL_BEGIN = 1u;
const uint SPIRAL_END = SHADOW == SHADOW_SOFT ? 17u : 2u;
// The rays of a pass. The first pass traces those from RIM_BEGIN on.
const uint PASS_RAYS = SHADOW == SHADOW_SOFT ? 8u : 1u;
const uint RIM_BEGIN = SHADOW == SHADOW_SOFT ? 9u : SPIRAL_BEGIN;
const uint FIRST_RAYS = SHADOW == SHADOW_SOFT ? 0xfe01u : 1u;
const vec2 GOLDEN_ANGLE = vec2(-0.73736888, 0.67549029); // cosine and sine
const vec2 RIM_ANGLE = vec2(0.93932130, 0.34303863); // PASS_RAYS golden angles

// The disc of a light, world axes.
struct Disc {
    vec3 middle; // unit, towards the light
    vec3 u;      // unit; u, v and middle are orthogonal
    vec3 v;
    float cap;   // 1 - cos of the angular radius
    vec2 first;  // cosine and sine of the angle of ray SPIRAL_BEGIN
};

// Returns the disc of a light; Duff et al. 2017 derive the two vectors orthogonal to the direction.
Disc disc_of(vec3 towards, float cap, uvec2 pixel)
{
    Disc disc;
    disc.middle = towards;
    float side = towards.z < 0.0 ? -1.0 : 1.0;
    float a = -1.0 / (side + towards.z);
    float b = towards.x * towards.y * a;
    disc.u = vec3(1.0 + side * towards.x * towards.x * a, side * b, -side * towards.x);
    disc.v = vec3(b, side + towards.y * towards.y * a, -towards.y);
    disc.cap = SHADOW == SHADOW_SOFT ? cap : 0.0;
    // The spiral's first angle, radians. It differs strongly and evenly between neighbouring pixels: multiples of the
    // two numbers of Roberts (2018). It also depends on the view, so that averaged pictures have different angles.
    uvec2 view = floatBitsToUint(frame.dir_00.xy);
    uint turn = pixel.x * 3242174889u + pixel.y * 2447445414u + (view.x ^ view.y) * 2654435769u;
    float begin = 1.4629180e-9 * float(turn); // 2 pi / 2^32
    disc.first = vec2(cos(begin), sin(begin));
    return disc;
}

// Returns the direction of ray `k` at this angle. All rays represent equal solid angles of the disc.
vec3 towards_disc(Disc disc, uint k, vec2 angle)
{
    float height = disc.cap * (float(k % LIGHT_RAYS) + 0.5) / float(LIGHT_RAYS);
    float aside = sqrt(height * (2.0 - height));
    return (1.0 - height) * disc.middle + aside * (angle.x * disc.u + angle.y * disc.v);
}

vec2 rotated(vec2 angle, vec2 by)
{
    return vec2(angle.x * by.x - angle.y * by.y, angle.x * by.y + angle.y * by.x);
}

vec2 next_angle(vec2 angle)
{
    return rotated(angle, GOLDEN_ANGLE);
}

// The cone of rays from a point to a disc.
struct Cone {
    vec3 from; // from the lower corner of the grid of hierarchies
    vec3 inverse; // 1 / the middle ray
    float widens; // tangent of the angle between the middle ray and the outermost one
    float slack;
};

Cone cone_to(Disc disc, vec3 origin, vec3 point)
{
    Cone cone;
    cone.from = frame_block.casters.eye + origin + point;
    cone.inverse = 1.0 / mix(disc.middle, vec3(1e-20), lessThan(abs(disc.middle), vec3(1e-20)));
    cone.widens = sqrt(disc.cap * (2.0 - disc.cap)) / max(1.0 - disc.cap, 1e-4);
    // Rays begin in the hierarchy's box.
    vec3 corner = frame_block.casters.middle + frame_block.casters.half_size;
    cone.slack = 2e-6 * (length(frame_block.casters.eye) + length(corner));
    return cone;
}

// Returns true if a cone may hit a node's box.
bool cone_may_meet(Cone cone, vec3 middle, vec3 half_size)
{
    vec3 way = middle - cone.from;
    vec3 reach = half_size + cone.widens * (length(way) + length(half_size)) + cone.slack;
    vec3 a = (way - reach) * cone.inverse;
    vec3 b = (way + reach) * cone.inverse;
    vec3 near = min(a, b);
    vec3 far = max(a, b);
    return max(max(near.x, near.y), max(near.z, 0.0)) <= min(far.x, min(far.y, far.z));
}

// Returns the rays of `left` that the current object does not block, of the pass that begins with ray `begin`.
uint unstopped_by(Instance i, vec3 origin, vec3 point, Disc disc, uint begin, uint left)
{
    vec3 eye = point_to_axis(i, origin, point);
    RayStart start = TO_LIGHT;
    vec2 angle = begin == SPIRAL_BEGIN ? disc.first : rotated(disc.first, RIM_ANGLE);
    for (uint k = begin; k < begin + PASS_RAYS; ++k) {
        vec3 v = direction_to_object(i, towards_disc(disc, k, angle));
        Hit hit;
        uint ray = 1u << k % LIGHT_RAYS;
        if ((left & ray) != 0u && trace(eye, v, 0.0, start, hit)) {
            left &= ~ray;
        }
        angle = next_angle(angle);
    }
    return left;
}

// Returns `met` if that is a copy, else the next copy that the rays may hit, or INNER_NODE. `k`: the next node, or 0 at
// the end. `map`: index of the copy's shape map, where searches read maps.
uint next_caster(vec3 origin, vec3 point, Disc disc, uint map, uint met, inout uint k)
{
    // The cone is made anew for each copy, since it would take 8 registers while rays are traced.
    Cone cone = cone_to(disc, origin, point);
    uint root = frame_block.casters.root;
    uint leaves = node_at(root).index;
    vec3 half_unit = 0.5 * frame_block.eye.grid_unit;
    while (met == INNER_NODE && k != 0u) {
        WalkNode node = node_at(root + k);
        uvec3 low = node.bounds & 0xffffu;
        uvec3 high = node.bounds >> 16;
        bool meets = cone_may_meet(cone, vec3(low + high) * half_unit, vec3(high - low) * half_unit);
        bool ends = k >= leaves;
        met = meets && ends ? node.index : INNER_NODE;
#if READS_MAP
        if (met != INNER_NODE && objects[instances[met].object].object.shape.shadow_map != map) {
            met = INNER_NODE;
        }
#endif
        uint next = k + 1u >> findLSB(k + 1u);
        k = meets && !ends ? 2u * k : next == 1u ? 0u : next;
    }
    return met;
}

// Returns the rays of `left`, one bit each, that no solid blocks, of the pass that begins with ray `begin`.
uint unstopped(vec3 origin, vec3 point, Disc disc, uint begin, uint left)
{
    // The root is in the block of the frame, which software drivers read much faster than the nodes.
    CasterRoot all = frame_block.casters;
    bool meets = cone_may_meet(cone_to(disc, origin, point), all.middle, all.half_size);
    uint only = meets ? all.only_copy : INNER_NODE;
    // The index of a map must be the same in all invocations, so each map has a walk of its own.
#if READS_MAP
    uint maps = frame_block.casters.map_count;
#else
    uint maps = 1u;
#endif
    for (uint map = 0u; map < maps; ++map) {
        uint k = meets && only == INNER_NODE ? 2u : 0u;
        // All invocations first find a copy each (Aila and Laine 2009), then trace together.
        for (uint met = only; left != 0u; met = INNER_NODE) {
            met = next_caster(origin, point, disc, map, met, k);
            if (met == INNER_NODE) {
                break;
            }
            Instance i = instance_at(met);
            load_shape(i);
#if READS_MAP
            // This equals `map`. SwiftShader fetches by the index of an invocation that may be inactive; there a load
            // gives 0, and a loop's counter an index without a texture.
            is_shadow_map = true;
            shadow_map = int(objects[i.object].object.shape.shadow_map);
#endif
            left = unstopped_by(i, origin, point, disc, begin, left);
        }
    }
    return left;
}

// Returns the rays of `open`, one bit each, that reach the light. `point` is relative to `origin`, and `origin` to the
// eye; world axes. The members of `shape` are those of another solid afterwards: restoring them would take registers.
uint reaching(vec3 origin, vec3 point, Disc disc, uint open)
{
    // If the first rays agree, their result holds for all rays.
    uint asked = FIRST_RAYS;
    uint lit = 0u;
    for (uint pass = 0u; asked != 0u; ++pass) {
        uint left = unstopped(origin, point, disc, pass == 0u ? RIM_BEGIN : SPIRAL_BEGIN, open & asked);
        bool agree = pass == 0u && (left == asked || left == 0u);
        lit |= agree && left != 0u ? ALL_RAYS : left;
        asked = pass == 0u && !agree ? ALL_RAYS & ~FIRST_RAYS : 0u;
    }
    return lit & open;
}

#endif
