// Search for live parameters. It reads only the map, so nothing is rebuilt when e, b or c change.
//
// docs/searches.md has the bound of a safe step and its proof. If the secant of the last two samples puts the surface
// farther away, the step is extended towards it by at most a texel. A minimum step near the surface brackets the
// surface, and the secant through the bracket gives the hit. A ray that only comes close is never a hit.
#ifndef SEARCH_LIVE_GLSL
#define SEARCH_LIVE_GLSL
#include "core/surface.glsl"

// Constants of a ray.
struct RayConstants {
    float speed2;  // squared speed of the ray in space
    float speed;
    float j2;      // J^2: the ray's acceleration in the half-plane is J^2 / r^3
    float nearest; // least distance from the axis
};

// Returns the largest step from s that cannot cross the surface; `f` is side * F at s.
float safe_step(Meridian m, RayConstants ray, float side, float s, vec2 rz, float f)
{
    float moment = m.a * s + m.b;
    float r = max(rz.x, 1e-6);
    float closest = max(moment >= 0.0 ? r : ray.nearest, r - f);
    float cube = closest * closest * closest;
    if (!bool(BEVELED)) {
        // Ball: the distance decreases by at most `speed` per unit of s. Torus: the disc of radius f about the sample,
        // swept around the axis, gives f / sqrt(sigma^2 + kappa f). Both share one division.
        float rr = r * r;
        float sigma2_rr = max(ray.speed2 * rr - ray.j2, m.v.z * m.v.z * rr);
        return f * max(m.inverse_speed, sqrt(cube * rr / (cube * sigma2_rr + ray.j2 * f * rr + 1e-30)));
    }
    float kappa = ray.j2 / max(cube, 1e-12);
    // Squared speed of the ray in the half-plane.
    float sigma2 = max(ray.speed2 - ray.j2 / (r * r), m.v.z * m.v.z);
    // A ray inside the solid has no bound from the tangent of w, so the steepest slope is used.
    float slope = side < 0.0 ? shape.bevel * abs(m.v.z) : offset_slope(rz.y) * m.v.z; // dw/ds
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
    // Minimum step: a quarter of a texel, or if greater, a tenth of a pixel but at most a hundredth of the ray's
    // length.
    float texel = shape.texel * m.inverse_speed;
    float least = max(0.25 * texel, 0.1 * min(pixel, 0.1 * m.s_end));
    vec2 rz = point_rz(m, s);
    // Start of the last step, and F at both of its ends. The initial values put the secant's zero at the ray's start.
    float before = s;
    float f_before = f + 1.0;
    int most = int(shape.most_steps);
    for (int i = 1; i < most && (i == 1 || (f > 0.0 && s < m.s_end)); ++i) {
        float safe = safe_step(m, ray, side, s, rz, f);
        // The step ends slightly beyond the secant's zero, so that the next one does not stop short again. The secant
        // is useless for a ray along the surface; there the step is extended by a texel.
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
    return s >= m.s_end ? LEFT : (f < shape.texel ? NEARLY : EXHAUSTED);
}

#endif
