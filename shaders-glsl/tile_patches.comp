#version 450
#extension GL_GOOGLE_include_directive : require
// Intersects the pixels of a tile with its listed patches.
#define SINGLE
#include "search/listed.glsl"

void main()
{
    take_frame();
    take_record();
    take_only_object(pushed.object); // before any barrier: see take_frame()
    share_tile();
    barrier();
    take_shared();
    begin_tile();
    uvec2 pixel = tile_corner() + gl_LocalInvocationID.xy;
    Hit hit;
    bool found = search_listed(pixel, hit);
    store_tile(pixel, found, hit);
}
