// The search for live parameters: on the map alone, nothing rebuilt when e, b or c move.
//
// Steps that are safe (proof in docs/searches.md): in the half-plane the ray moves away from a sample by at most sigma
// x + kappa x^2 / 2 after x units of s, and w, being concave along the ray, stays below its tangent; so as long as both
// together do not use up F, nothing is met. Where the secant of the last two samples shows the surface farther on, a
// step goes on towards it by a texel at most: what it may pass is a chord of a texel. Near the surface a least step
// brackets it, and the secant through the bracket is the hit: a ray that only comes near is no hit, however near.
#ifndef SEARCH_LIVE_GLSL
#define SEARCH_LIVE_GLSL
#include "core/surface.glsl"

// What does not change along a ray.
struct RayConstants {
    float speed2;  // of the ray in space, squared
    float speed;
    float j2;      // J^2: the ray's acceleration in the half-plane is J^2 / r^3
    float nearest; // to the axis
};

// The largest step from s that cannot pass the surface; `f` is side * F there.
float safe_step(Meridian m, RayConstants ray, float side, float s, vec2 rz, float f)
{
    float moment = m.a * s + m.b;
    float r = max(rz.x, 1e-6);
    float closest = max(moment >= 0.0 ? r : ray.nearest, r - f);
    float cube = closest * closest * closest;
    if (!bool(BEVELED)) {
        // Ball: the distance shrinks by at most `speed` for each unit of s. Torus: the disc of radius f about the
        // sample, swept around the axis, f / sqrt(sigma^2 + kappa f), with one division for all.
        float rr = r * r;
        float sigma2_rr = max(ray.speed2 * rr - ray.j2, m.v.z * m.v.z * rr);
        return f * max(m.inverse_speed, sqrt(cube * rr / (cube * sigma2_rr + ray.j2 * f * rr + 1e-30)));
    }
    float kappa = ray.j2 / max(cube, 1e-12);
    // The ray's speed in the half-plane, squared.
    float sigma2 = max(ray.speed2 - ray.j2 / (r * r), m.v.z * m.v.z);
    // From within, the tangent to w bounds nothing: take the steepest.
    float slope = side < 0.0 ? solid.offset.y * abs(m.v.z) : offset_slope(rz.y) * m.v.z; // dw/ds
    float ball = f / max(ray.speed + slope, 1e-3 * ray.speed);
    float rate = sqrt(sigma2) + slope;
    float root = rate + sqrt(max(rate * rate, 0.0) + 2.0 * kappa * f);
    float torus = root > 1e-6 * ray.speed ? 2.0 * f / root : ball;
    return max(ball, torus);
}

uint search(Meridian m, float side, float f, float pixel, inout float s, inout uint steps)
{
    RayConstants ray;
    ray.speed2 = dot(m.v, m.v);
    ray.speed = ray.speed2 * m.inverse_speed;
    ray.j2 = max(m.a * m.c - m.b * m.b, 0.0);
    ray.nearest = sqrt(ray.j2 / max(m.a, 1e-20));
    // A quarter of a texel, or a tenth of a pixel where texels are smaller; of the way through a flat box a hundredth.
    float texel = solid.map.z * m.inverse_speed;
    float least = max(0.25 * texel, 0.1 * min(pixel, 0.1 * m.s_end));
    vec2 rz = point_rz(m, s);
    // The last step: where it began, and F at both of its ends. Of none the secant shows the surface where the ray is.
    float before = s;
    float f_before = f + 1.0;
    int most = int(solid.offset.w);
    for (int i = 1; i < most && (i == 1 || (f > 0.0 && s < m.s_end)); ++i) {
        float safe = safe_step(m, ray, side, s, rz, f);
        // A little beyond where the secant meets the surface, so that the next step does not end before it again; of a
        // ray that goes along the surface the secant says nothing, and a texel is as good.
        float beyond = f * (s - before) / (f_before - f) + least;
        beyond = min(beyond, safe + texel);
        float stride = beyond > safe ? beyond : safe;
        before = s;
        f_before = f;
        s = min(s + max(stride, least), m.s_end);
        rz = point_rz(m, s);
        f = side * field(rz);
        ++steps;
    }
    if (f <= 0.0) {
        s = mix(before, s, f_before / max(f_before - f, 1e-30));
        return FOUND;
    }
    return s >= m.s_end ? LEFT : (f < solid.map.z ? NEARLY : EXHAUSTED);
}

#endif
