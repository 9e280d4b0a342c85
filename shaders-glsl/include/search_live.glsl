// The search for live parameters: on the map alone, nothing rebuilt when e, b or c move.
//
// Steps never pass the surface (proof in docs/searches.md). In the half-plane the ray moves away from a sample by at most
// sigma x + kappa x^2 / 2 after x units of s, and w, being concave along the ray, stays below its tangent; so as long as both
// together do not use up F, nothing is met. Near the surface a least step brackets it, and the secant through the bracket is the
// hit: a ray that only comes near is no hit, however near.
#ifndef SEARCH_LIVE_GLSL
#define SEARCH_LIVE_GLSL
#include "surface.glsl"

// The largest step from s that cannot pass the surface; `f` is side * F there.
float safe_step(Meridian m, float side, float s, vec2 rz, float f)
{
    float speed = 1.0 / m.inverse_speed;
    float slope = offset_slope(rz.y) * m.v.z; // dw/ds
    if (OFFSET == OFFSET_BEVELED && side < 0.0) {
        slope = solid.offset.y * abs(m.v.z); // from within, the tangent bounds nothing: take the steepest
    }
    // Ball: the distance shrinks by at most `speed` for each unit of s.
    float ball = OFFSET == OFFSET_BEVELED ? f / max(speed + slope, 1e-3 * speed) : f * m.inverse_speed;
    // Torus: the disc of radius f about the sample, swept around the axis.
    float moment = m.a * s + m.b;
    float r = max(rz.x, 1e-6);
    float sigma = sqrt(moment * moment / (r * r) + m.v.z * m.v.z);
    float j2 = max(m.a * m.c - m.b * m.b, 0.0);
    float nearest = moment >= 0.0 ? r : sqrt(j2 / max(m.a, 1e-20));
    float closest = max(nearest, r - f);
    float kappa = j2 / max(closest * closest * closest, 1e-12);
    float rate = sigma + slope;
    float root = rate + sqrt(max(rate * rate, 0.0) + 2.0 * kappa * f);
    float torus = root > 1e-6 * speed ? 2.0 * f / root : ball;
    return max(ball, torus);
}

uint search_live(Meridian m, float side, float f, float t_pixel, inout float s, inout uint steps)
{
    // A quarter of a texel, or a tenth of a pixel where texels are smaller.
    float least = max(0.25 * solid.map.z * m.inverse_speed, 0.1 * t_pixel);
    for (uint i = 1u; i < MAX_STEPS; ++i) {
        float step_ = max(safe_step(m, side, s, point_rz(m, s), f), least);
        float next = s + step_;
        bool last = next >= m.s_end;
        next = min(next, m.s_end);
        float f_next = side * field(point_rz(m, next));
        ++steps;
        if (f_next <= 0.0) {
            s = mix(s, next, f / max(f - f_next, 1e-30));
            return FOUND;
        }
        s = next;
        f = f_next;
        if (last) {
            return LEFT;
        }
    }
    return f < solid.map.z ? NEARLY : EXHAUSTED;
}

#endif
