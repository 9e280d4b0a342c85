// Relaxed cone stepping (Policarpo and Oliveira 2007) over the rows of cones of cone_rows.glsl: cones that are as
// wide as lets a ray come out of the surface no sooner than it leaves them. So a step may end within, and is halved
// then. The cones assume rays that are straight in the half-plane and come from far off the axis. Rays here are
// neither, so the search passes surfaces (docs/searches.md).
#include "cone/cone_rows.glsl"

const int HALVINGS_OF_CONES = 12;

// The row at a height, and its radius and slope there.
vec4 row_at(float z, out vec2 radius)
{
    float n = float(shape.table_fact_0);
    float row = clamp(floor(z * n), 0.0, n - 1.0);
    vec4 cone = patch_vector(uint(row));
    float height = clamp(z - row / n, 0.0, 1.0 / n);
    radius = row_radius(cone, height, n, height >= level_height(cone, n));
    return cone;
}

// r^2 - g^2: negative where the surface has been passed.
float beside_row(Meridian m, float t, out vec4 cone, out vec2 radius)
{
    cone = row_at(m.o.z + t * m.v.z, radius);
    return square_at(m, t) - radius.x * radius.x;
}

// Of rays that begin outside.
uint search_relaxed(Meridian m, inout float s, inout uint steps, out vec4 hit_quadric)
{
    bool up = m.v.z >= 0.0;
    // The solid's own levels, floor and ceiling among them, are met at a row's border at the earliest.
    float least = m.inverse_speed / float(shape.table_fact_0);
    float t = 0.0;
    float before = 0.0;
    vec4 cone;
    vec2 radius;
    float outside = max(beside_row(m, t, cone, radius), 0.0);
    ++steps;
    int most = most_steps();
    for (int i = 1; i < most && outside >= 0.0 && t < m.s_end; ++i) {
        float leap = 0.0;
        if (cone.w >= 0.0) {
            leap = cone_root(m.a, m.b + m.a * t, square_at(m, t), radius.x, (up ? cone.z : cone.w) * abs(m.v.z), 1.0);
            leap = leap >= 0.0 ? leap : 3e38;
        }
        before = t;
        t = min(t + max(leap, least), m.s_end);
        outside = beside_row(m, t, cone, radius);
        ++steps;
    }
    bool found = outside < 0.0;
    int halvings = found ? HALVINGS_OF_CONES : 0;
    for (int i = 0; i < halvings; ++i) {
        float middle = 0.5 * (before + t);
        bool within = beside_row(m, middle, cone, radius) < 0.0;
        t = within ? middle : t;
        before = within ? before : middle;
        ++steps;
    }
    s = t;
    beside_row(m, s, cone, radius);
    // Deeper within than a halving explains: through a level face.
    bool face = radius.x - sqrt(max(square_at(m, s), 0.0)) > 2.0 * (t - before) / m.inverse_speed + 1e-6;
    hit_quadric = face ? vec4(0.0, 0.0, up ? -1.0 : 1.0, 0.0) : vec4(1.0, 0.0, -2.0 * radius.y * max(radius.x, 1e-6), 0.0);
    return found ? FOUND : t >= m.s_end ? LEFT : EXHAUSTED;
}

// Relaxed cones are for rays from outside. Rays towards lights take the others, which pass nothing.
uint search(Meridian m, float side, inout float s, inout uint steps, out vec4 quadric)
{
    uint end;
    if (side > 0.0 && !m.to_light) {
        end = search_relaxed(m, s, steps, quadric);
    } else {
        end = search_cone(m, side, s, steps, quadric);
    }
    return end;
}
