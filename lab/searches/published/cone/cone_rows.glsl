// Cone step mapping (Dummer 2006) in the half-plane, of solids r <= f(z): a table of rows of equal height, laid out and
// proven as src/cones.rs says. From a sample outside, the ray meets in its own row a frustum, exactly; beyond
// that row nothing before it leaves the row's widest empty cone. Both are cones of revolution about the axis, so both
// are quadratics in t.
//
// Never passes the surface, and advances by a row at least.
#ifndef CONE_ROWS_GLSL
#define CONE_ROWS_GLSL

// Where r^2 - (g + slope u)^2 falls to 0, `u` from a sample with r^2 = rr and half the rate of that; NaN or negative
// where it does not.
float cone_root(float a, float half_rate, float rr, float g, float slope, float side)
{
    float al = side * (a - slope * slope);
    float be = side * (half_rate - g * slope);
    float ga = side * (rr - g * g);
    float root = sqrt(be * be - al * ga);
    return be <= 0.0 ? ga / (root - be) : -(be + root) / al;
}

// Height of a row's level face over the row's lower border.
float level_height(vec4 cone, float n)
{
    return floor((-cone.w - 1.0) / 4096.0) / 2047.0 / n;
}

// Radius of the surface at a height over the row's lower border, and dr/dz there; beside a level face on its upper or
// lower side.
vec2 row_radius(vec4 cone, float height, float n, bool above)
{
    float slope = (cone.y - cone.x) * n;
    float g = cone.x + slope * height;
    if (cone.w < 0.0) {
        float face = level_height(cone, n);
        float upper = mod(-cone.w - 1.0, 4096.0) / 4095.0 * uintBitsToFloat(shape.table_fact_1);
        slope = above ? (cone.y - upper) / max(1.0 / n - face, 1e-7) : (cone.z - cone.x) / max(face, 1e-7);
        g = above ? upper + slope * (height - face) : cone.x + slope * height;
    }
    return vec2(max(g, 0.0), slope);
}

bool starts_in_table(Meridian m)
{
    float n = float(shape.table_fact_0);
    float z = clamp(m.o.z, 0.0, 1.0);
    float row = min(floor(z * n), n - 1.0);
    vec4 cone = patch_vector(uint(row));
    float height = z - row / n;
    float g = row_radius(cone, height, n, height >= level_height(cone, n)).x;
    return m.c < g * g;
}

// FOUND or LEFT; `hit_quadric` is the frustum that was hit, as `quadric_normal` wants it.
uint search_cone(Meridian m, float side, inout float s, inout uint steps, out vec4 hit_quadric)
{
    int rows = int(shape.table_fact_0);
    float n = float(rows);
    bool up = m.v.z >= 0.0;
    float per_z = 1.0 / (up ? max(m.v.z, 1e-20) : min(m.v.z, -1e-20));
    int row = clamp(int(floor(m.o.z * n)), 0, rows - 1);
    float t = 0.0;
    bool arrives = true;
    bool past = false; // the row's level face
    hit_quadric = vec4(0.0);
    bool found = false;
    for (int i = 0; i <= 2 * rows; ++i) {
        vec4 cone = patch_vector(uint(row));
        ++steps;
        float low = float(row) / n;
        float height = m.o.z + t * m.v.z - low;
        bool level = cone.w < 0.0;
        float face = level_height(cone, n);
        past = arrives ? (up ? height >= face : height <= face) : past;
        vec2 g = row_radius(cone, height, n, past == up);
        float rr = square_at(m, t);
        float half_rate = m.b + m.a * t;
        float border = level && !past ? low + face : float(up ? row + 1 : row) / n;
        float leave = clamp((border - m.o.z) * per_z, t, max(m.s_end, t));
        // Where the radius jumps the ray is in already; at a plain border by a rounding.
        float depth = side * (g.x * g.x - rr);
        bool in_already = i > 0 && depth >= 0.0;
        float u = in_already ? 0.0 : cone_root(m.a, half_rate, rr, g.x, g.y * m.v.z, side);
        found = u >= 0.0 && t + u <= leave;
        if (found) {
            s = t + u;
            bool face = in_already && depth > 2e-6;
            hit_quadric = face ? vec4(0.0, 0.0, up == (side > 0.0) ? -1.0 : 1.0, 0.0)
                               : vec4(1.0, 0.0, -2.0 * g.y * max(g.x + g.y * m.v.z * u, 1e-6), 0.0);
            break;
        }
        float next = leave;
        if (side > 0.0 && !level) {
            float leap = cone_root(m.a, half_rate, rr, g.x, (up ? cone.z : cone.w) * abs(m.v.z), 1.0);
            next = leap >= 0.0 ? max(t + leap, leave) : 3e38;
        }
        t = next;
        arrives = !level || past;
        past = true;
        if (arrives) {
            int reached = int(floor((m.o.z + t * m.v.z) * n));
            row = up ? max(row + 1, reached) : min(row - 1, reached);
        }
        if (next >= m.s_end || row < 0 || row >= rows) {
            break;
        }
    }
    return found ? FOUND : LEFT;
}

#endif
