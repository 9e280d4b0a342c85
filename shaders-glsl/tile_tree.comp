#version 450
#extension GL_GOOGLE_include_directive : require
// Traces the pixels of single-copy tiles through the tree, like the fragments of a box.
#include "stage/tile.glsl"

void main()
{
    take_frame();
    take_record();
    tile_instance = instances[instance_number()];
    take_only_object(pushed.object);
    take_one_of_objects(tile_instance);
    begin_tile();
    // Records of the last bin contain the span. Records in tile order do not.
    vec2 span = reads_bin() && is_outside() ? uintBitsToFloat(tile_record.zw) : EVERYWHERE;
    uvec2 pixel = tile_corner() + gl_LocalInvocationID.xy;
    Hit hit;
    bool found = trace(ray_origin(tile_rays, pixel), ray_direction(tile_rays, pixel), tile_rays.base, span, hit);
    store_tile(pixel, found, hit);
}
