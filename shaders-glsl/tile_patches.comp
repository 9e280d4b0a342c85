#version 450
#extension GL_GOOGLE_include_directive : require
// Intersects the pixels of a tile with its listed patches.
#define SINGLE
#define UNSHADOWED
#include "search/listed.glsl"

void main()
{
    load_frame(pushed.object);
    load_tile();
    share_object();
    share_patches();
    barrier();
    load_shared();
    begin_tile();
    uvec2 pixel = tile_corner() + gl_LocalInvocationID.xy;
    Hit hit;
    bool found = search_listed(pixel, hit);
    store_tile(pixel, found, hit);
}
