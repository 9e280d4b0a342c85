#version 450
#extension GL_GOOGLE_include_directive : require
// Lists, for each tile, the patches that its rays may meet. A work group has a square of tiles: its invocations first
// share the patches out and keep those that the square's rays may meet; of these each then takes its own tile's.
#include "stage/patch_runs.glsl"
#include "stage/beam.glsl"
#include "core/meridian.glsl"

const uint LIST_WORDS = (LISTED_PATCHES + 31u) / 32u;
shared uint met[LIST_WORDS]; // a bit a patch

void main()
{
    take_frame();
    take_solid();
    PixelRays rays = pixel_rays(solid.single);
    float farthest = farthest_of(rays, solid.single);
    uvec2 tile = uvec2(pushed.corner & 0xffffu, pushed.corner >> 16) + gl_GlobalInvocationID.xy;
    uvec2 square = tile - gl_LocalInvocationID.xy;
    // Not from the uniform buffer: lavapipe 22 takes uniforms that loops depend on for constants.
    uvec2 header = patch_tables[solid.hull.z].xy;
    float unit = uintBitsToFloat(header.y);

    uint self = gl_LocalInvocationIndex;
    if (self < LIST_WORDS) {
        met[self] = 0u;
    }
    barrier();
    Beam wide = beam_of(rays, square * GROUP_PIXELS, GROUP_PIXELS * GROUP_PIXELS, farthest, unit);
    vec2 unused;
    for (uint k = self; k < header.x; k += GROUP_PIXELS * GROUP_PIXELS) {
        if (may_meet(wide, k, unused)) {
            atomicOr(met[k >> 5], 1u << (k & 31u));
        }
    }
    barrier();

    Beam beam = beam_of(rays, tile * GROUP_PIXELS, GROUP_PIXELS, farthest, unit);
    // Where the box cuts the solid, a tile of which some ray may have been in it before the box's sides has no list:
    // that ray may meet a cut.
    bool cut = false;
    vec2 outer = vec2(-1e30, 1e30);
    vec2 inner = vec2(-1e30, 1e30);
    if (OUTSIDE == 0u) {
        vec4 wider = beam.width * vec4(-1.0, -1.0, 1.0, 1.0);
        outer = between_sides(beam.o, beam.v, sides_of_box() + wider);
        inner = between_sides(beam.o, beam.v, sides_of_box() - wider);
        inner.x = inner.x <= inner.y ? inner.x : 1e30;
    }
    PatchRuns runs = NO_PATCHES;
    vec2 range = vec2(1e30, -1e30);
    for (uint w = 0u; w << 5 < header.x; ++w) {
        uint rest = met[w];
        while (rest != 0u) {
            uint k = w << 5 | uint(findLSB(rest));
            rest &= rest - 1u;
            vec2 span;
            bool meets = may_meet(beam, k, span) && span.x <= outer.y;
            cut = cut || meets && span.x < inner.x;
            range = meets ? vec2(min(range.x, span.x), max(range.y, span.y)) : range;
            take_patch(runs, k, meets);
        }
    }
    uvec2 lengths = lengths_of(runs);
    uint place = tile.x | tile.y << 16;
    bool shows = runs.any && outer.x <= outer.y && all(lessThan(tile * GROUP_PIXELS, frame.size.xy));
    bool is_long = cut || lengths.x + lengths.y > LONGEST_LIST;
    if (OUTSIDE == 0u) {
        // Most of a cut: no ray of the tile has to be searched.
        bool into_solid = shows && cut && inner.x < 1e30;
        vec2 t = into_solid ? vec2(outer.x, inner.x) : vec2(0.0);
        vec2 z = vec2(min(t.x * beam.v.z, t.y * beam.v.z), max(t.x * beam.v.z, t.y * beam.v.z)) + beam.o.z;
        vec2 rows = floor((z + beam.width * vec2(-1.0, 1.0)) * float(SOLID_ROWS));
        vec2 apart = t - beam.nearest;
        float radius = sqrt(beam.least + beam.a * max(apart.x * apart.x, apart.y * apart.y)) + beam.width;
        into_solid = into_solid && rows.x >= 0.0 && rows.y < float(SOLID_ROWS);
        uint row = into_solid ? uint(rows.x) : 0u;
        uint end = into_solid ? uint(rows.y) + 1u : 0u;
        uint words = 4u * (solid.hull.z + 4u + 3u * header.x);
        while (row < end) {
            into_solid = into_solid && uintBitsToFloat(patch_tables[(words + row) >> 2][row & 3u]) >= radius;
            ++row;
        }
        if (into_solid) {
            append(LIST_LENGTHS, place, 0u);
            shows = false;
        }
    }
    if (shows && is_long) {
        uint at = pushed.first_bin + 4u + 4u * atomicAdd(bin_words[pushed.first_bin], 1u);
        bin_words[at] = place;
        bin_words[at + 1u] = floatBitsToUint(max(range.x, -rays.base));
        bin_words[at + 2u] = floatBitsToUint(range.y);
    }
    if (shows && !is_long) {
        append_patches(place, runs, lengths);
    }
}
