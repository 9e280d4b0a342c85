#version 450
#extension GL_GOOGLE_include_directive : require
// A square of pixels in which one copy may show. Its fragments search that copy as in a box; where the box cuts nothing
// and the eye is outside, between the first and the last t at which any of them may meet it.
#include "stage/vertex.glsl"
#include "stage/box_varyings.glsl"
#include "stage/square.glsl"
#include "stage/beam_span.glsl"

void main()
{
    Square square = this_square();
    // What is drawn to warm pipelines up may be any record.
    Instance i = begin(min(square.words.x, uint(instances.length()) - 1u));
    place_square(square);
    hand_over(i, frame.dir_00.w);
    hand_over_box();
#if DISPATCH == DISPATCH_BEAMS
    PixelRays rays = pixel_rays(i);
    Beam beam = beam_of(rays, square.corner, square.side, farthest_of(rays, i), 0.0);
    // The next coarser nodes: vertices are many.
    box_axis.xy = beam_span(beam, solid.hull.y + BEAM_NODES / 4u, BEAM_NODES / 4u);
#endif
}
