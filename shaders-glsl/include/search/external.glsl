// Hook for searches of other crates. Their build scripts put a file `search/hook.glsl` here. A search on the map
// defines one function:
//
//     uint search(Meridian m, float side, float f, float pixel, inout float s, inout uint steps)
//
// A search on a table of its own (SEARCH_TABLE) defines two:
//
//     uint search(Meridian m, float side, inout float s, inout uint steps, out vec4 quadric)
//     bool starts_in_table(Meridian m)
//
// `search` moves `s` from 0 to the first hit before m.s_end and returns FOUND. It returns LEFT if there is no hit. If
// the steps run out, it returns NEARLY close to the surface, else EXHAUSTED. Lengths are in units of `s`
// (core/meridian.glsl); those of the map are in object units.
// - `side`: -1 for a ray that begins within the solid and searches for the exit; else 1.
// - `f`: max(side * F, 0) at s = 0. F is `field(point_rz(m, s))` (core/surface.glsl).
// - `pixel`: width of a pixel at s = 0, object units.
// - `steps`: number of look-ups of the map or of the table's rows.
// - `m.to_light`: the ray leads from a point to a light.
// - `quadric`: q of the hit patch, G = q.x r^2 + q.z (z - q.y) + q.w (z - q.y)^2 + any constant. The gradient of G is
//   the normal.
// `starts_in_table` returns true if the ray begins within the solid; it reads only m.o and m.c.
//
// `patch_vector` (core/patch_tables.glsl) reads the table. shape.table_fact_0 to table_fact_2 holds three words about it, defined by
// `SearchTable` in src/search/mod.rs.
#ifndef SEARCH_EXTERNAL_GLSL
#define SEARCH_EXTERNAL_GLSL
#if SEARCH_TABLE
#include "search/quadric.glsl"
#else
#include "core/surface.glsl"
#endif

#if TAKES_STEPS
// Upper limit on steps. Loops of constant length are a tenth faster in lavapipe.
int most_steps()
{
    return KNOWN_STEPS != 0u ? int(KNOWN_STEPS) : int(shape.most_steps);
}
#endif

#include "search/hook.glsl"

#endif
