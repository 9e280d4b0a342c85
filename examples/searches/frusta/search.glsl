// Contour tracing: the solid as a pile of frusta. The ray passes the rows in the order of height, which is the order of s.
// In each row it meets r = g + k (z - low), a cone: a quadratic in s.

uint search(Meridian m, float side, inout float s, inout uint steps, out vec4 quadric)
{
    int rows = int(table_length());
    float n = float(rows);
    bool up = m.v.z >= 0.0;
    int row = clamp(int(floor(m.o.z * n)), 0, rows - 1);
    float from = 0.0;
    bool found = false;
    quadric = vec4(0.0);
    for (int i = 0; i < rows && !found && row >= 0 && row < rows && from < m.s_end; ++i) {
        vec4 radii = table_vector(uint(row));
        ++steps;
        float k = (radii.y - radii.x) * n;
        float border = float(up ? row + 1 : row) / n;
        float leave = abs(m.v.z) > 1e-9 ? min((border - m.o.z) / m.v.z, m.s_end) : m.s_end;
        // r^2 - (g + k vz s)^2 = al s^2 + 2 be s + ga
        float g = radii.x + k * (m.o.z - float(row) / n);
        float al = m.a - k * k * m.v.z * m.v.z;
        float be = m.b - g * k * m.v.z;
        float ga = m.c - g * g;
        float root = sqrt(be * be - al * ga); // NaN: the ray misses the cone
        float hit = be <= 0.0 ? ga / (root - be) : -(be + root) / al;
        // In the solid where the row begins: through the level face that two rows with different radii leave.
        float depth = -((al * from + 2.0 * be) * from + ga);
        bool level = depth > 2e-6;
        found = level || (hit >= from - 1e-6 && hit <= leave + 1e-6);
        s = level ? from : hit;
        float radius = max(g + k * m.v.z * s, 1e-6);
        quadric = level ? vec4(0.0, 0.0, up ? -1.0 : 1.0, 0.0) : vec4(1.0, 0.0, -2.0 * k * radius, 0.0);
        from = leave;
        row += up ? 1 : -1;
    }
    return found ? FOUND : LEFT;
}
