// The hook for searches of other crates: `search/hook.glsl` is a file of theirs, which their build scripts put here.
// It defines one function,
//
//     uint search(Meridian m, float side, float f, float pixel, inout float s, inout uint steps)
//
// of searches on the map, and of those on tables of their own (SEARCH_TABLE)
//
//     uint search(Meridian m, float side, inout float s, inout uint steps, out vec4 quadric)
//     bool starts_in_table(Meridian m)
//
// `search` moves `s` from 0 on to the first point of the surface that the ray meets before m.s_end, and returns FOUND;
// LEFT where it meets none; NEARLY or EXHAUSTED where its steps are used up, near the surface or not. Lengths are units
// of `s` (core/meridian.glsl); those of the map are object units.
// - `side`: -1 for a ray that begins within the solid, which looks for the way out; else 1.
// - `f`: side * F at s = 0, positive unless the ray begins on the surface. F is `field(point_rz(m, s))`
//   (core/surface.glsl).
// - `pixel`: width of a pixel there, object units.
// - `steps`: counts look-ups of the map or of the table's rows.
// - `quadric`: of the surface where it is met, G = q.x r^2 + q.y + q.z z + q.w z^2, of which the gradient is the normal.
// `starts_in_table` says whether the ray begins within the solid; it reads m.o and m.c alone.
//
// A table is read by `patch_vector` (core/patch_tables.glsl). Three words about it are in solid.patches.yzw, as
// `SearchTable` of src/search.rs has them.
#ifndef SEARCH_EXTERNAL_GLSL
#define SEARCH_EXTERNAL_GLSL
#if SEARCH_TABLE
#include "search/quadric.glsl"
#else
#include "core/surface.glsl"
#endif

#if TAKES_STEPS
// The bound on steps. Loops of a length that is known cost lavapipe a tenth less.
int most_steps()
{
    return KNOWN_STEPS != 0u ? int(KNOWN_STEPS) : int(solid.offset.w);
}
#endif

#include "search/hook.glsl"

#endif
