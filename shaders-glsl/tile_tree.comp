#version 450
#extension GL_GOOGLE_include_directive : require
// Traces the pixels of single-copy tiles through the tree, like the fragments of a box.
#include "stage/shared_object.glsl"

void main()
{
    load_frame(pushed.object);
    load_tile();
    // On GPUs what comes from shared memory takes vector registers, so only the general form reads its object there.
    if (ONE_OBJECT == 0u) {
        share_object();
        barrier();
        load_shared();
    } else {
        tile_instance = instances[instance_number()];
        load(tile_instance);
    }
    begin_tile();
    // Only tiles of bins contain the span.
    vec2 span = reads_bin() && is_outside() ? uintBitsToFloat(tile.found) : EVERYWHERE;
    uvec2 pixel = tile_corner() + gl_LocalInvocationID.xy;
    Hit hit;
    bool found = trace(ray_origin(tile_rays, pixel), ray_direction(tile_rays, pixel), tile_rays.base, span, hit);
    store_tile(pixel, found, hit);
}
