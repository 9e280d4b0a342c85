// Between which t a beam may meet a solid: by rows of equal height and the largest radius of each.
#ifndef BEAM_SPAN_GLSL
#define BEAM_SPAN_GLSL
#include "stage/beam.glsl"

// The first t is behind the last where the beam meets nothing. The `count` rows are nodes of the tree, from this vector on.
vec2 beam_span(Beam beam, uint first, uint count)
{
    // Divided anew: of a plate a thousand times as wide as high a rounding of the inverse loses pixels.
    float nearest = -beam.b / beam.a;
    float least = max(dot(beam.o.xy, beam.o.xy) - beam.a * nearest * nearest, 0.0);
    vec2 span = vec2(1e30, -1e30);
    for (uint k = 0u; k < count; ++k) {
        // Not from the uniform buffer: lavapipe 22 takes uniforms that branches depend on for constants, and crashes
        // over it.
        float most = node_extent(patch_tables[first + (k >> 2)][k & 3u]).y;
        float radius = sqrt(max(most, 0.0)) + beam.width;
        float low = (float(k) / float(count) - beam.width - beam.o.z) * beam.per_z;
        float high = (float(k + 1u) / float(count) + beam.width - beam.o.z) * beam.per_z;
        float reach = sqrt(max(radius * radius - least, 0.0) / beam.a);
        float enter = max(min(low, high), nearest - reach);
        float leave = min(max(low, high), nearest + reach);
        bool meets = most > 0.0 && radius * radius > least && enter <= leave;
        span = meets ? vec2(min(span.x, enter), max(span.y, leave)) : span;
    }
    return vec2(max(span.x, -beam.base), span.y);
}

#endif
