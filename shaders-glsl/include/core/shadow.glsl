// Visible fraction of a light at a point, from rays towards the light that are traced against every solid of the scene.
#ifndef SHADOW_GLSL
#define SHADOW_GLSL
#if SHADOWED
#include "core/pixel_ray.glsl"
#include "core/replicas.glsl"

layout(set = 0, binding = 3, std140) uniform ShadowBlock {
    uvec4 shadow_count; // x: number of objects
    Object shadow_objects[MAX_SHADOW_OBJECTS];
};

// Rays per light: one, or several in a spiral over its disc (Vogel 1979) that each pixel rotates by its own angle.
const uint LIGHT_RAYS = SHADOW == SHADOW_SOFT ? 16u : 1u;
const uint ALL_RAYS = SHADOW == SHADOW_SOFT ? 0xffffu : 1u; // one bit per ray
const uint FIRST_RAYS = SHADOW == SHADOW_SOFT ? 0xfc09u : 1u; // rays to the disc's rim and middle
const vec2 GOLDEN_ANGLE = vec2(-0.73736888, 0.67549029); // cosine and sine

// The disc of a light, world axes.
struct Disc {
    vec3 middle; // unit, towards the light
    vec3 u;      // unit; u, v and middle are orthogonal
    vec3 v;
    float cap;   // 1 - cos of the angular radius
    vec2 first;  // cosine and sine of the spiral's first angle
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
    float height = disc.cap * (float(k) + 0.5) / float(LIGHT_RAYS);
    float aside = sqrt(height * (2.0 - height));
    return (1.0 - height) * disc.middle + aside * (angle.x * disc.u + angle.y * disc.v);
}

vec2 next_angle(vec2 angle)
{
    return vec2(angle.x * GOLDEN_ANGLE.x - angle.y * GOLDEN_ANGLE.y, angle.x * GOLDEN_ANGLE.y + angle.y * GOLDEN_ANGLE.x);
}

// Returns true if the cone of rays to the disc may hit a sphere around `middle`, relative to the rays' origin.
bool may_meet(Disc disc, vec3 middle, float radius)
{
    float along = dot(middle, disc.middle);
    float aside = sqrt(max(dot(middle, middle) - along * along, 0.0));
    float from_cone = aside * (1.0 - disc.cap) - along * sqrt(disc.cap * (2.0 - disc.cap));
    float slack = 1e-3 * (radius + abs(along));
    return from_cone <= radius + slack && along >= -radius - slack;
}

// Returns the rays of `left` that the current object does not block.
uint unstopped_by(Instance i, vec3 origin, vec3 point, Disc disc, uint left)
{
    vec3 eye = point_to_axis(i, origin, point);
    vec2 angle = disc.first;
    for (uint k = 0u; k < LIGHT_RAYS; ++k) {
        vec3 v = direction_to_object(i, towards_disc(disc, k, angle));
        Hit hit;
        if ((left >> k & 1u) != 0u && trace(eye, v, 0.0, EVERYWHERE, hit)) {
            left &= ~(1u << k);
        }
        angle = next_angle(angle);
    }
    return left;
}

// Returns the rays of `left`, one bit each, that no solid blocks.
uint unstopped(vec3 origin, vec3 point, Disc disc, uint left)
{
    for (uint b = 0u; b < shadow_count.x && left != 0u; ++b) {
        uint first = shadow_objects[b].instances.x;
        uint end = first + shadow_objects[b].instances.y;
        for (uint n = first; n < end && left != 0u; ++n) {
            vec3 middle = instances[n].position_sx.xyz - origin - point;
            bool near = may_meet(disc, middle, uintBitsToFloat(instances[n].object.y));
            // This is a loop because software drivers execute the body of a branch even if no lane takes it.
            for (uint k = near ? 0u : LIGHT_RAYS; k < LIGHT_RAYS; k = LIGHT_RAYS) {
                object = shadow_objects[b];
                shadow_map = int(object.instances.z);
                left = unstopped_by(instances[n], origin, point, disc, left);
            }
        }
    }
    return left;
}

// Returns the visible fraction of the light, 0 to 1. `point` is relative to `origin`, and `origin` to the eye; world
// axes. `normal` points to the lit side; directions below its horizon are hidden.
float light_reaching(vec3 origin, vec3 point, vec3 normal, Disc disc)
{
    uint open = 0u;
    vec2 angle = disc.first;
    for (uint k = 0u; k < LIGHT_RAYS; ++k) {
        open |= dot(normal, towards_disc(disc, k, angle)) > 0.0 ? 1u << k : 0u;
        angle = next_angle(angle);
    }
    Object own = object;
    casts = true;
    // If the first rays agree, their result holds for all rays.
    uint asked = FIRST_RAYS;
    uint lit = 0u;
    for (uint pass = 0u; asked != 0u; ++pass) {
        uint left = unstopped(origin, point, disc, open & asked);
        bool agree = pass == 0u && (left == asked || left == 0u);
        lit |= agree && left != 0u ? ALL_RAYS : left;
        asked = pass == 0u && !agree ? ALL_RAYS & ~FIRST_RAYS : 0u;
    }
    object = own;
    casts = false;
    return float(bitCount(lit)) / float(LIGHT_RAYS);
}

#endif
#endif
