// Texture coordinates (xi, eta) and their analytic gradients over the surface (2025 article, eqs 10 to 17, with z up).
// Differences of neighbouring pixels would contain the jump of the azimuth, and compute has no neighbours.
#ifndef TEXTURING_GLSL
#define TEXTURING_GLSL
#include "core/blocks.glsl"

layout(set = 1, binding = 1) uniform sampler2D color_map;
layout(set = 1, binding = 2) uniform sampler2D displacement_map;
layout(set = 1, binding = 3) uniform sampler2D arc_map;

const float PI = 3.14159265358979;

struct Coordinates {
    vec2 uv;      // (xi, eta), before the texture's repetition and offset
    vec3 grad_xi; // gradient over object space
    vec3 grad_eta;
};

// Returns the arc length at the outline's point nearest to (r, z), as a fraction, bilinear between texels. The length
// of a closed outline wraps to 0 at one point; smaller values there are increased by one. `rising`: direction of
// increase, not normalised.
float arc_length(vec2 rz, out vec2 rising)
{
    vec2 size = shape.map_size;
    vec2 texel = vec2(rz.x, 1.0 - rz.y) / shape.texel - 0.5;
    vec2 base = clamp(floor(texel), vec2(0.0), max(size - 2.0, 0.0));
    vec4 eta = textureGather(arc_map, (base + 1.0) / size);
    float most = max(max(eta.x, eta.y), max(eta.z, eta.w));
    eta += vec4(lessThan(eta, vec4(most - 0.5)));
    vec2 position = clamp(texel - base, 0.0, 1.0);
    rising = vec2(mix(eta.z - eta.w, eta.y - eta.x, position.y), mix(eta.w - eta.x, eta.z - eta.y, position.x));
    vec2 across = mix(eta.wx, eta.zy, position.x);
    float mixed = mix(across.x, across.y, position.y);
    return mixed > 1.0 ? mixed - 1.0 : mixed;
}

// Returns profile units per object unit; the box may have grown with the offset.
float profile_units()
{
    return appearance.box_height;
}

// Returns the coordinates at `point`, object units relative to the axis. `n`: normal. Gradients are per profile unit.
Coordinates texture_coordinates(vec3 point, vec3 n)
{
    Coordinates c;
    vec3 p = point * profile_units() - vec3(0.0, 0.0, appearance.box_low);
    float r2 = dot(p.xy, p.xy);
    float r = sqrt(r2);
    c.grad_xi = vec3(-p.y, p.x, 0.0) / (2.0 * PI * max(r2, 1e-12));
    c.uv.x = r > 0.0 ? (PI + atan(p.y, p.x)) / (2.0 * PI) : 0.5;
    if (PROJECTION == PROJECTION_PLANAR) {
        float width = appearance.profile_width;
        c.uv = (p.xy + shape.axis * profile_units()) / width + 0.5;
        c.grad_xi = vec3(1.0 / width, 0.0, 0.0);
        c.grad_eta = vec3(0.0, 1.0 / width, 0.0);
    } else if (PROJECTION == PROJECTION_SPHERICAL) {
        vec3 q = p - vec3(0.0, 0.0, 0.5);
        float rho2 = max(dot(q, q), 1e-12);
        // acos loses half of its digits at the poles; atan of both legs loses none.
        c.uv.y = 1.0 - atan(r, q.z) / PI;
        c.grad_eta = -vec3(q.xy * (q.z / max(r, 1e-6)), -r) / (PI * rho2);
    } else if (PROJECTION == PROJECTION_ARC) {
        vec2 rising;
        c.uv.y = arc_length(vec2(length(point.xy), point.z), rising);
        vec3 around = vec3(-p.y, p.x, 0.0) / max(r, 1e-6);
        // Rate of arc length along the surface. Its sign is reversed within a cavity, and it is larger where an outline
        // is shorter. The table is invalid between the two sides of a thin wall; the rate of the longest outline is
        // used there.
        vec3 along = cross(n, around);
        float rate = dot(rising, vec2(dot(along.xy, p.xy) / max(r, 1e-6), along.z)) / shape.texel;
        c.grad_eta = along * ((abs(rate) < 16.0 * appearance.arc_rate ? rate : appearance.arc_rate) / profile_units());
    } else {
        c.uv.y = p.z;
        c.grad_eta = vec3(0.0, 0.0, 1.0);
    }
    return c;
}

// Returns the change of the surface point per pixel: the neighbour's ray is intersected with the tangent plane.
vec3 footprint(vec3 v, vec3 dv, vec3 n, float t)
{
    float facing = dot(n, v);
    facing = abs(facing) < 1e-3 * length(v) ? 1e-3 * length(v) : facing;
    return t * (dv - v * (dot(n, dv) / facing));
}

// Returns the position in a map; eta = 1 is the top row.
vec2 map_position(Coordinates c)
{
    return vec2(c.uv.x, 1.0 - c.uv.y) * appearance.texture_repeat + appearance.texture_offset;
}

// Returns the change of that position along `way`, profile units.
vec2 map_change(Coordinates c, vec3 way)
{
    return vec2(dot(c.grad_xi, way), dot(c.grad_eta, way)) * (vec2(1.0, -1.0) * appearance.texture_repeat);
}

vec4 sample_repeated(sampler2D map, Coordinates c, vec3 right, vec3 down)
{
    return textureGrad(map, map_position(c), map_change(c, right), map_change(c, down));
}

float height_at(vec2 position, vec2 change_x, vec2 change_y)
{
    return textureGrad(displacement_map, position, change_x, change_y).r;
}

// Returns the slopes of the displacement map: changes of height over its whole width and, upwards, its height.
vec2 slopes(Coordinates c, vec3 right, vec3 down)
{
    if ((BUMP & BUMP_HEIGHTS) == 0u) {
        return sample_repeated(displacement_map, c, right, down).rg;
    }
    // Differences of the neighbouring texels, or across the pixel where that is wider.
    vec2 at = map_position(c);
    vec2 change_x = map_change(c, right), change_y = map_change(c, down);
    vec2 half_way = max(1.0 / vec2(textureSize(displacement_map, 0)), 0.5 * max(abs(change_x), abs(change_y)));
    vec2 right_way = vec2(half_way.x, 0.0), up = vec2(0.0, -half_way.y);
    float from_left = height_at(at + right_way, change_x, change_y) - height_at(at - right_way, change_x, change_y);
    float from_below = height_at(at + up, change_x, change_y) - height_at(at - up, change_x, change_y);
    return 0.5 * vec2(from_left, from_below) / half_way;
}

// Returns the normal tilted by the displacement map: the surface gradient of the height (Mikkelsen 2010), scaled by
// `a`. BUMP_PAPERS is the papers' form, in which a turn around the axis has length 1 at any radius.
vec3 bumped(vec3 n, vec3 p, Coordinates c, vec3 right, vec3 down)
{
    vec2 slope = slopes(c, right, down) * appearance.texture_repeat;
    vec3 g;
    if ((BUMP & BUMP_PAPERS) != 0u) {
        float r = length(p.xy);
        vec3 around = r > 1e-7 ? vec3(-p.y, p.x, 0.0) / r : vec3(0.0, 1.0, 0.0);
        g = slope.x * around + slope.y * cross(n, around);
    } else {
        g = slope.x * c.grad_xi + slope.y * c.grad_eta;
    }
    vec3 tilted = n - appearance.bump * (g - n * dot(n, g));
    float len = length(tilted);
    return len > 0.0 ? tilted / len : n;
}

#endif
