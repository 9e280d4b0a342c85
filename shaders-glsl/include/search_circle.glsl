// Circle tracing as in the papers (article of 2022, eqs 1, 8 to 10, 13): steps of the distance read, a fixed number of them; under
// a bevel steps are not shortened, and where one ends within the surface it is halved ten times.
// Safe where F is 1-Lipschitz, which a bevel breaks: thin parts can be stepped over (docs/searches.md).
#ifndef SEARCH_CIRCLE_GLSL
#define SEARCH_CIRCLE_GLSL
#include "surface.glsl"

// Stored in 8 bits the distance comes in stairs, below half a texel it says nothing more.
float hit_threshold()
{
    return solid.map.z * (MAP_FORMAT == FORMAT_RGBA8 ? 0.5 : 0.02);
}

const uint PAPERS_HALVINGS = 10u;

// Halves the step back from within the surface, as the papers do.
float papers_halving(Meridian m, float side, float s, float last, inout uint steps)
{
    for (uint i = 0u; i < PAPERS_HALVINGS; ++i) {
        last *= 0.5;
        s += side * field(point_rz(m, s)) < 0.0 ? -last : last;
        ++steps;
    }
    return s;
}

// `side` is -1 for a ray that starts within the solid; `f` is side * F at s.
uint search_circle(Meridian m, float side, float f, inout float s, inout uint steps)
{
    float threshold = hit_threshold();
    float last = 0.0;
    for (uint i = 1u; i < MAX_STEPS; ++i) {
        if (OFFSET == OFFSET_BEVELED && f < 0.0) {
            s = papers_halving(m, side, s, last, steps);
            return FOUND;
        }
        if (f < threshold) {
            return FOUND;
        }
        vec2 rz = point_rz(m, s);
        // The papers step by the distance to the extended form, not to the beveled one.
        float bevel = OFFSET == OFFSET_BEVELED ? side * (offset_width(rz.y) - solid.offset.x) : 0.0;
        last = max(f + bevel, threshold) * m.inverse_speed;
        s += last;
        if (s > m.s_end) {
            return LEFT;
        }
        f = side * field(point_rz(m, s));
        ++steps;
    }
    // Out of steps: the papers show what has come near.
    return f < solid.map.z ? NEARLY : EXHAUSTED;
}

#endif
