#version 450
#extension GL_GOOGLE_include_directive : require
// Solves the pixels of tiles whose patches are listed.
#include "search/listed.glsl"

void main()
{
    begin_frame();
    share_record();
    barrier();
    take_shared_record();
    share_instance();
    share_patches();
    barrier();
    begin_tile(shared_copy());
    uvec2 pixel = tile_corner() + gl_LocalInvocationID.xy;
    Nearest nearest;
    bool found = search_listed(pixel, nearest);
    store_tile(pixel, found, nearest);
}
