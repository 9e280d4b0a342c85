// Circle tracing as in the papers (article of 2022, eqs 1, 8 to 10, 13): steps of the distance read, a fixed number of
// them; under a bevel steps are not shortened, and where one ends within the surface it is halved ten times. Safe where
// F is 1-Lipschitz, which a bevel breaks: thin parts can be stepped over (docs/searches.md).

// Stored in 8 bits the distance comes in stairs, below half a texel it says nothing more.
float hit_threshold()
{
    return shape.texel * (RGBA8 != 0 ? 0.5 : 0.02);
}

const int PAPERS_HALVINGS = 10;

// `side` is -1 for a ray that starts within the solid; `f` is side * F at s.
uint search(Meridian m, float side, float f, float pixel, inout float s, inout uint steps)
{
    float threshold = hit_threshold();
    float last = 0.0;
    bool found = false;
    bool left = false;
    int halvings = 0; // of a step that has passed the surface, as only a bevel lets it
    int most = most_steps();
    for (int i = 1; i < most || halvings > 0; ++i) {
        bool passed = bool(BEVELED) && (halvings > 0 || (shape.bevel != 0.0 && f < 0.0));
        found = passed || f < threshold;
        if (halvings == PAPERS_HALVINGS || (found && !passed)) {
            break;
        }
        // The papers step by the distance to the extended form, not to the beveled one.
        float bevel = bool(BEVELED) ? side * (offset_width(point_rz(m, s).y) - shape.extend) : 0.0;
        last = passed ? 0.5 * last : max(f + bevel, threshold) * m.inverse_speed;
        s += passed && f < 0.0 ? -last : last;
        halvings += passed ? 1 : 0;
        left = s > m.s_end && !passed;
        if (left) {
            break;
        }
        f = side * field(point_rz(m, s));
        ++steps;
    }
    // Out of steps: the papers show what has come near.
    return left ? LEFT : found ? FOUND : (f < shape.texel ? NEARLY : EXHAUSTED);
}
