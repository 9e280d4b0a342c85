// Interval arithmetic along the ray (Mitchell 1990; without a stack as by Knoll et al. 2009). Over a segment of the ray
// r and z are in intervals: z is linear, r(s) is convex. The field over the rectangle of both is that at its middle, give
// or take half the diagonal (d is 1-Lipschitz), and the offset's width is largest at the lower end. If this bound is
// positive, the segment is free and the next one is twice as long. Otherwise its first half comes next.

uint search(Meridian m, float side, float f, float pixel, inout float s, inout uint steps)
{
    float least = width * shape.texel * m.inverse_speed;
    float nearest = -m.b / max(m.a, 1e-20); // s at which the ray is nearest to the axis
    float segment = 0.25 * m.s_end;
    bool found = false;
    int most = most_steps();
    for (int i = 1; i < most && s < m.s_end && !found; ++i) {
        float to = min(s + segment, m.s_end);
        vec2 a = point_rz(m, s);
        vec2 b = point_rz(m, to);
        float low = point_rz(m, clamp(nearest, s, to)).x;
        vec2 from = vec2(low, min(a.y, b.y));
        vec2 upto = max(a, b);
        // F on the rectangle lies within `spread` of F at its middle.
        float spread = 0.5 * length(upto - from);
        if (bool(BEVELED)) {
            spread += 0.5 * abs(shape.bevel) * (upto.y - from.y);
        }
        f = side * field(0.5 * (from + upto));
        ++steps;
        if (f > spread) {
            s = to;
            segment *= 2.0;
        } else if (segment > least) {
            segment *= 0.5;
        } else {
            // Too short to halve: a hit if its middle is in the solid.
            found = f <= 0.0; // lavapipe 22 crashes over `break` here
            s = found ? 0.5 * (s + to) : to;
        }
    }
    return found ? FOUND : s >= m.s_end ? LEFT : f < shape.texel ? NEARLY : EXHAUSTED;
}
