// Segment tracing (Galin et al. 2020). Sphere tracing divides the field by a Lipschitz bound that holds everywhere. Here the
// bound holds for the next segment of the ray and in its direction, so it is smaller and the step is longer.
//
// The field is a distance d(r, z), whose own bound is 1 everywhere. All that can be gained is the speed of the ray in the
// half-plane, |(dr/ds, dz/ds)|: it is less than |v| while the ray moves around the axis. r(s) is convex, so dr/ds grows
// along the ray, and the larger of its values at the segment's ends bounds it in between.

// Largest |dF/ds| over a segment of the ray. Under a bevel dF/ds has the part -dw/ds, which is monotone too.
float bound(Meridian m, float side, float from, float to)
{
    vec2 a = point_rz(m, from);
    vec2 b = point_rz(m, to);
    float most = sqrt(m.a); // near the axis the quotient is a rounding over a rounding
    vec2 across = min(abs(m.a * vec2(from, to) + m.b) / max(vec2(a.x, b.x), 1e-7), most);
    float speed = sqrt(max(across.x * across.x, across.y * across.y) + m.v.z * m.v.z);
    float rise = 0.0; // of the offset's width along the ray
    if (bool(BEVELED)) {
        rise = max(side * m.v.z * offset_slope(a.y), side * m.v.z * offset_slope(b.y));
    }
    return speed + max(rise, 0.0);
}

uint search(Meridian m, float side, float f, float pixel, inout float s, inout uint steps)
{
    float threshold = 0.02 * shape.texel;
    float segment = growth * f * m.inverse_speed;
    int most = most_steps();
    for (int i = 1; i < most && f >= threshold && s <= m.s_end; ++i) {
        float stride = min(f / bound(m, side, s, s + segment), segment);
        s += stride;
        segment = max(growth * stride, threshold * m.inverse_speed);
        f = side * field(point_rz(m, s));
        ++steps;
    }
    if (s > m.s_end && f >= threshold) {
        return LEFT;
    }
    return f < threshold ? FOUND : f < shape.texel ? NEARLY : EXHAUSTED;
}
