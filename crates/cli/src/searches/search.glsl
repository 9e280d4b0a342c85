// Finds the first point of a solid along a ray. docs/your-own-search.md explains the arguments.
//
// m      the ray: a point at s is point_rz(m, s) = (radius, height), and the ray ends at m.s_end
// side   1 outside the solid, -1 for a ray that begins within
// f      side * F at s = 0; F = field(point) is the distance to the surface, negative in the solid
// pixel  width of a pixel at s = 0
// s      in: 0. out: the hit
// steps  add 1 for each look-up of the map
uint search(Meridian m, float side, float f, float pixel, inout float s, inout uint steps)
{
    float threshold = 0.02 * object.map.z; // object.map.z: a texel
    for (int i = 1; i < most_steps() && f >= threshold && s <= m.s_end; ++i) {
        // Distances are in object units; m.inverse_speed converts them to units of s.
        s += factor * f * m.inverse_speed;
        f = side * field(point_rz(m, s));
        ++steps;
    }
    if (s > m.s_end) {
        return LEFT; // no hit
    }
    return f < threshold ? FOUND : f < object.map.z ? NEARLY : EXHAUSTED;
}
