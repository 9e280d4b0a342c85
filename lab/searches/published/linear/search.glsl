// The linear searches of relief mapping: equal steps along the clipped ray until one ends within the surface; then
// nothing (`linear`), halvings (`relief`, Policarpo et al. 2005) or secants (`secant`, interval mapping, Risser et al.
// 2006). Not safe: what is thinner than a step is stepped over.

// SEARCH_FORM, the key `form` of search.toml; else nothing follows.
const uint HALVINGS = 1u;
const uint SECANTS = 2u;

const uint RELIEF_HALVINGS = 8u;
const uint SECANT_STEPS = 3u;

uint search(Meridian m, float side, float f, float pixel, inout float s, inout uint steps)
{
    // Lavapipe 22 crashes over loops whose length is a uniform alone.
    int most = m.s_end >= 0.0 ? most_steps() : 0;
    float stride = m.s_end / float(most);
    float before = 0.0; // where F was last found to be positive
    float f_in = 0.0;
    bool found = false;
    for (int i = 1; i <= most && !found; ++i) {
        s = float(i) * stride;
        f_in = side * field(point_rz(m, s));
        ++steps;
        found = f_in <= 0.0;
        before = found ? before : s;
        f = found ? f : f_in;
    }
    if (found && SEARCH_FORM == HALVINGS) {
        for (uint i = 0u; i < RELIEF_HALVINGS; ++i) {
            float middle = 0.5 * (before + s);
            bool within = side * field(point_rz(m, middle)) <= 0.0;
            ++steps;
            s = within ? middle : s;
            before = within ? before : middle;
        }
    }
    if (found && SEARCH_FORM == SECANTS) {
        for (uint i = 0u; i < SECANT_STEPS; ++i) {
            float guess = mix(before, s, f / max(f - f_in, 1e-30));
            float f_guess = side * field(point_rz(m, guess));
            ++steps;
            bool within = f_guess <= 0.0;
            f_in = within ? f_guess : f_in;
            s = within ? guess : s;
            f = within ? f : f_guess;
            before = within ? before : guess;
        }
        s = mix(before, s, f / max(f - f_in, 1e-30));
    }
    return found ? FOUND : LEFT;
}
