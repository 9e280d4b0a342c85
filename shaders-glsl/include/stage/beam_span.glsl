// Range of t in which a beam may hit a solid, from the largest radii of the nodes at one level of the tree.
#ifndef BEAM_SPAN_GLSL
#define BEAM_SPAN_GLSL
#include "stage/beam.glsl"

const uint SPAN_NODES = 16u; // nodes of the second level from the top
const uint SPAN_FIRST = 320u; // index of its first node

// Returns the range of t in which a beam may hit node `k`; the range is empty (x > y) if it cannot.
vec2 node_span(Beam beam, uint k)
{
    // This divides again: rounding of `inverse_a` loses pixels of a plate that is a thousand times as wide as high.
    float nearest = -beam.b / beam.a;
    float least = max(dot(beam.o.xy, beam.o.xy) - beam.a * nearest * nearest, 0.0);
    // Storage buffer only: lavapipe 22 treats uniforms that branches depend on as constants, and crashes.
    uint at = SPAN_FIRST + k;
    float most = node_extent(patch_tables[solid.patches.x + (at >> 2)][at & 3u]).y;
    float radius = sqrt(max(most, 0.0)) + beam.width;
    float low = (float(k) / float(SPAN_NODES) - beam.width - beam.o.z) * beam.per_z;
    float high = (float(k + 1u) / float(SPAN_NODES) + beam.width - beam.o.z) * beam.per_z;
    float reach = sqrt(max(radius * radius - least, 0.0) / beam.a);
    vec2 span = vec2(max(min(low, high), nearest - reach), min(max(low, high), nearest + reach));
    bool meets = most > 0.0 && radius * radius > least && span.x <= span.y;
    return meets ? span : vec2(3e38, -3e38);
}

vec2 beam_span(Beam beam)
{
    vec2 span = vec2(3e38, -3e38);
    for (uint k = 0u; k < SPAN_NODES; ++k) {
        vec2 met = node_span(beam, k);
        span = vec2(min(span.x, met.x), max(span.y, met.y));
    }
    return span;
}

#endif
