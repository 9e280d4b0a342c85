#version 450
#extension GL_GOOGLE_include_directive : require
// Traces the pixels of tiles whose patches are listed.
#include "stage/tile_patches.glsl"
#include "stage/stores.glsl"

void main()
{
    take_list();
    begin();
    take_single(tile_instance());
    uvec2 pixel = tile_corner() + gl_LocalInvocationID.xy;
    Nearest nearest;
    bool found = nearest_in_tile(pixel, nearest);
    if (all(lessThan(pixel, frame.size.xy))) {
        count_steps(pixel, nearest);
        if (found && (DEPTH_TEST == 0u || nearest.depth < uintBitsToFloat(pixel_words[depth_word(pixel)]))) {
            keep_depth(pixel, nearest);
            store(pixel, shade_nearest(pixel, nearest));
        }
    }
}
