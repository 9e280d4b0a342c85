#version 450
#extension GL_GOOGLE_include_directive : require
// Vertices of a quad in which one copy may be visible. Its fragments search that copy like those of a box.
#include "stage/vertex.glsl"
#include "stage/tree_varyings.glsl"
#include "stage/quad.glsl"
#include "stage/beam.glsl"

void main()
{
    Quad quad = this_quad();
    // A draw that only warms up pipelines may read any record.
    Instance i = begin(min(quad.instance, uint(instances.length()) - 1u));
    position_quad(quad);
    hand_over(i, frame.dir_00.w);
    vec2 span = EVERYWHERE;
    if (OUTSIDE != 0u) {
        PixelRays rays = pixel_rays(i);
        span = beam_span(beam_of(rays, quad.corner, quad.side, farthest_of(rays, i), 0.0));
    }
    hand_over_tree(span);
}
