// Texture coordinates (xi, eta) and their gradients over the surface, from formulas: neighbouring pixels do not see the
// jump of the azimuth, and compute has no neighbours. (Article of 2025, eqs 10 to 17, with z up.)
#ifndef TEXTURING_GLSL
#define TEXTURING_GLSL
#include "core/blocks.glsl"

#if TEXTURED || OUTPUT == OUTPUT_PLANES
layout(set = 1, binding = 1) uniform sampler2D color_map;
layout(set = 1, binding = 2) uniform sampler2D displacement_map;
layout(set = 1, binding = 3) uniform sampler2D arc_map;

const float PI = 3.14159265358979;

struct Coordinates {
    vec2 uv;      // (xi, eta), before the texture's repetition
    vec3 grad_xi; // over object space
    vec3 grad_eta;
};

// Length along the outline at its point nearest to (r, z), as a fraction; between texels bilinear. A closed outline's
// lengths start again from 0 somewhere: there the smaller ones count one more. `rising`: whither it grows, of no
// particular length.
float arc_length(vec2 rz, out vec2 rising)
{
    vec2 size = solid.map.xy;
    vec2 texel = vec2(rz.x, 1.0 - rz.y) / solid.map.z - 0.5;
    vec2 base = clamp(floor(texel), vec2(0.0), max(size - 2.0, 0.0));
    vec4 eta = textureGather(arc_map, (base + 1.0) / size);
    float most = max(max(eta.x, eta.y), max(eta.z, eta.w));
    eta += vec4(lessThan(eta, vec4(most - 0.5)));
    vec2 place = clamp(texel - base, 0.0, 1.0);
    rising = vec2(mix(eta.z - eta.w, eta.y - eta.x, place.y), mix(eta.w - eta.x, eta.z - eta.y, place.x));
    vec2 across = mix(eta.wx, eta.zy, place.x);
    float mixed = mix(across.x, across.y, place.y);
    return mixed > 1.0 ? mixed - 1.0 : mixed;
}

// Units of the profile's box for one of the box's own, which may have grown with the offset.
float profile_units()
{
    return solid.specular.z;
}

// At `place`, object units about the axis; `n` the surface's normal there. Gradients are over the profile's units.
Coordinates texture_coordinates(vec3 place, vec3 n)
{
    Coordinates c;
    vec3 p = place * profile_units() - vec3(0.0, 0.0, solid.specular.w);
    float r2 = dot(p.xy, p.xy);
    float r = sqrt(r2);
    c.grad_xi = vec3(-p.y, p.x, 0.0) / (2.0 * PI * max(r2, 1e-12));
    c.uv.x = r > 0.0 ? (PI + atan(p.y, p.x)) / (2.0 * PI) : 0.5;
    if (PROJECTION == PROJECTION_PLANAR) {
        float width = solid.texturing.w;
        c.uv = (p.xy + solid.axis.xy * profile_units()) / width + 0.5;
        c.grad_xi = vec3(1.0 / width, 0.0, 0.0);
        c.grad_eta = vec3(0.0, 1.0 / width, 0.0);
    } else if (PROJECTION == PROJECTION_SPHERICAL) {
        vec3 q = p - vec3(0.0, 0.0, 0.5);
        float rho2 = max(dot(q, q), 1e-12);
        // acos loses half its digits at the poles; atan of both legs none.
        c.uv.y = 1.0 - atan(r, q.z) / PI;
        c.grad_eta = -vec3(q.xy * (q.z / max(r, 1e-6)), -r) / (PI * rho2);
    } else if (PROJECTION == PROJECTION_ARC) {
        vec2 rising;
        c.uv.y = arc_length(vec2(length(place.xy), place.z), rising);
        vec3 around = vec3(-p.y, p.x, 0.0) / max(r, 1e-6);
        // By how much lengths grow along the surface: within a cavity the other way round than outside, and faster
        // where an outline is shorter. Between the two sides of a thin wall the table says nothing; there the longest
        // outline's rate stands in.
        vec3 along = cross(n, around);
        float rate = dot(rising, vec2(dot(along.xy, p.xy) / max(r, 1e-6), along.z)) / solid.map.z;
        c.grad_eta = along * ((abs(rate) < 16.0 * solid.axis.z ? rate : solid.axis.z) / profile_units());
    } else {
        c.uv.y = p.z;
        c.grad_eta = vec3(0.0, 0.0, 1.0);
    }
    return c;
}

// How the surface's point moves from pixel to pixel: the neighbour's ray, met with the tangent plane.
vec3 footprint(vec3 v, vec3 dv, vec3 n, float t)
{
    float facing = dot(n, v);
    facing = abs(facing) < 1e-3 * length(v) ? 1e-3 * length(v) : facing;
    return t * (dv - v * (dot(n, dv) / facing));
}

vec4 sample_repeated(sampler2D map, Coordinates c, vec3 right, vec3 down)
{
    vec2 repeat = solid.texturing.xy;
    vec2 turn = vec2(1.0, -1.0) * repeat; // eta = 1 is the top row
    vec2 dx = vec2(dot(c.grad_xi, right), dot(c.grad_eta, right)) * turn;
    vec2 dy = vec2(dot(c.grad_xi, down), dot(c.grad_eta, down)) * turn;
    return textureGrad(map, vec2(c.uv.x * repeat.x, (1.0 - c.uv.y) * repeat.y), dx, dy);
}

#if TEXTURED
// The normal tilted by the displacement map: the gradient of the height along the surface (Mikkelsen 2010), scaled by
// `a`; or the papers' form, in which a turn around the axis counts as one unit of length wherever it is.
vec3 bumped(vec3 n, vec3 p, Coordinates c, vec3 right, vec3 down)
{
    vec2 slope = sample_repeated(displacement_map, c, right, down).rg * solid.texturing.xy;
    vec3 g;
    if (BUMP == BUMP_PAPERS) {
        float r = length(p.xy);
        vec3 around = r > 1e-7 ? vec3(-p.y, p.x, 0.0) / r : vec3(0.0, 1.0, 0.0);
        g = slope.x * around + slope.y * cross(n, around);
    } else {
        g = slope.x * c.grad_xi + slope.y * c.grad_eta;
    }
    vec3 tilted = n - solid.texturing.z * (g - n * dot(n, g));
    float len = length(tilted);
    return len > 0.0 ? tilted / len : n;
}
#endif

#endif
#endif
