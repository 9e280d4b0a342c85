#version 450
#extension GL_GOOGLE_include_directive : require
// Intersects the pixels of a tile with its listed patches.
#define SINGLE
#include "search/listed.glsl"

void main()
{
    take_frame();
    take_only_object(pushed.object); // before any barrier: see take_frame()
    share_patches();
    barrier();
    take_shared_instance();
    take_one_of_objects(tile_instance);
    begin_tile();
    uvec2 pixel = tile_corner() + gl_LocalInvocationID.xy;
    Hit hit;
    bool found = search_listed(pixel, hit);
    store_tile(pixel, found, hit);
}
