#version 450
#extension GL_GOOGLE_include_directive : require
// One invocation a tile of GROUP_PIXELS^2: lists the tiles whose rays may meet the solid, and between which t. The
// list's length becomes the number of work groups of the dispatch that follows.
#include "stage/beams.glsl"
#include "stage/beam_span.glsl"

void main()
{
    take_frame();
    take_solid();
    PixelRays rays = pixel_rays(solid.single);
    uvec2 tile = uvec2(pushed.corner & 0xffffu, pushed.corner >> 16) + gl_GlobalInvocationID.xy;
    uvec2 corner = tile * GROUP_PIXELS;
    vec2 span = beam_span(beam_of(rays, corner, GROUP_PIXELS, farthest_of(rays, solid.single), 0.0), solid.hull.y, BEAM_NODES);
    if (span.x <= span.y && all(lessThan(corner, frame.size.xy))) {
        uint at = pushed.first_bin + 4u + 4u * atomicAdd(bin_words[pushed.first_bin], 1u);
        bin_words[at] = tile.x | tile.y << 16;
        bin_words[at + 1u] = floatBitsToUint(span.x);
        bin_words[at + 2u] = floatBitsToUint(span.y);
    }
}
