// The surface F = d - w(z) = 0, with w = e + b min(u, c), u = 1 - z (method of the 2022 article, eqs 8, 9 and 13).
#ifndef SURFACE_GLSL
#define SURFACE_GLSL
#include "core/shape_map.glsl"
#include "core/meridian.glsl"

float offset_width(float z)
{
    if (!bool(BEVELED)) {
        return shape.extend;
    }
    return shape.extend + shape.bevel * min(1.0 - z, shape.chamfer);
}

// Returns dw/dz.
float offset_slope(float z)
{
    return bool(BEVELED) && 1.0 - z < shape.chamfer ? -shape.bevel : 0.0;
}

float field(vec2 rz)
{
    return map_distance(rz) - offset_width(rz.y);
}

// Returns d(r, z)/ds; dr/ds is 0 on the axis, where the radius has no direction.
vec2 meridian_velocity(Meridian m, float s, float r)
{
    return vec2(r > 1e-7 ? (m.a * s + m.b) / r : 0.0, m.v.z);
}

// Returns the unit normal in object space. `side` is -1 if the ray comes from within.
vec3 surface_normal(Meridian m, float s, float side)
{
    vec3 p = m.o + s * m.v;
    vec2 rz = point_rz(m, s);
    vec2 g = map_gradient(rz, side * meridian_velocity(m, s, rz.x));
    g.y -= offset_slope(rz.y);
    // The azimuth is undefined on the axis, so the radial part of the normal is 0 there.
    vec3 n = vec3(rz.x > 1e-7 ? g.x * p.xy / rz.x : vec2(0.0), g.y);
    float len = length(n);
    return len > 0.0 ? n / len : vec3(0.0, 0.0, 1.0);
}

// Result codes of a search.
const uint FOUND = 0u;
const uint LEFT = 1u;      // the ray left the region without a hit
const uint EXHAUSTED = 2u; // the steps were used up
const uint NEARLY = 3u;    // the steps were used up within a texel of the surface: counts as a hit

#endif
