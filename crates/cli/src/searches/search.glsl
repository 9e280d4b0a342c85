// Finds the first point of a solid along a ray. docs/your-own-search.md explains the arguments.
//
// m      the ray: a point at s is point_rz(m, s) = (radius, height), and the ray ends at m.s_end
// side   -1 for a ray that begins within the solid, else 1. Where the solid touches its cylinder F is about 0 at both
//        ends of the ray, and side may be either; hence test f against a small threshold before the first step and at
//        m.s_end too, as this loop does
// f      max(side * F, 0) at s = 0, already counted in steps; F = field(point) is the distance to the surface, negative
//        in the solid
// pixel  width of a pixel at s = 0
// s      in: 0. out: the hit
// steps  add 1 for each look-up of the map
uint search(Meridian m, float side, float f, float pixel, inout float s, inout uint steps)
{
    float threshold = 0.02 * shape.texel; // shape.texel: a texel
    // most_steps() may be as small as 1.
    for (int i = 1; i < most_steps() && f >= threshold && s <= m.s_end; ++i) {
        // Distances are in object units; m.inverse_speed converts them to units of s.
        s += factor * f * m.inverse_speed;
        f = side * field(point_rz(m, s));
        ++steps;
    }
    if (s > m.s_end) {
        return LEFT; // no hit
    }
    return f < threshold ? FOUND : f < shape.texel ? NEARLY : EXHAUSTED;
}
