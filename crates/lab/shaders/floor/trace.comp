#version 450
#extension GL_GOOGLE_include_directive : require
// The floor of rectangles and of tiles without lists: a ray hits where it enters the solid's bounding cylinder, or
// where its tile's beam may first meet the solid.
#include "stage/bins.glsl"
#include "stage/stores.glsl"
#include "entry.glsl"

void main()
{
    begin();
    Bin bin = this_bin();
    uvec2 pixel = this_pixel(bin);
    if (all(lessThan(pixel, frame.size.xy))) {
        Nearest nearest;
#if DISPATCH == DISPATCH_BEAMS
        bool found = true;
        nearest.hit.t = uintBitsToFloat(bin.first);
        nearest.hit.point = ray_origin(single_rays, pixel) + nearest.hit.t * ray_direction(single_rays, pixel);
        nearest.hit.normal = vec3(nearest.hit.point.xy, 0.0);
        nearest.hit.sense = vec3(1.0);
        nearest.hit.at_border = false;
#else
        bool found = entry_hit(single_rays, pixel, nearest.hit);
#endif
        nearest.instance = 0u;
        nearest.steps = 0u;
        nearest.exhausted = false;
        nearest.depth = depth_of(single_rays.base + nearest.hit.t);
        count_steps(pixel, nearest);
        if (found && (DEPTH_TEST == 0u || nearest.depth < uintBitsToFloat(pixel_words[depth_word(pixel)]))) {
            keep_depth(pixel, nearest);
            store(pixel, shade_nearest(pixel, nearest));
        }
    }
}
