#version 450
#extension GL_GOOGLE_include_directive : require
// Traces the pixels of single-copy tiles through the tree, like the fragments of a box.
#include "stage/compute.glsl"

void main()
{
    take_frame();
    take_lights();
    uint at = 4u * (pushed.first + gl_WorkGroupID.x);
    uint corner = tile_words[at];
    Instance i = instances[ONE_INSTANCE != 0u ? pushed.instance : tile_words[at + 1u]];
    take_solid(ONE_SOLID != 0u ? pushed.solid : i.solid.x);
    Look look = look_of(i);
    PixelRays rays = pixel_rays(i);
    uvec2 pixel = uvec2(corner & 0xffffu, corner >> 16) + gl_LocalInvocationID.xy;
    Hit hit;
    bool found = trace(ray_origin(rays, pixel), ray_direction(rays, pixel), rays.base, EVERYWHERE, hit);
    float depth = depth_of(rays.base + hit.t);
    if (all(lessThan(pixel, frame.size.xy))) {
        count_steps(pixel, hit);
        if (found && (DEPTH_TEST == 0u || depth < drawn_depth(pixel))) {
            store(pixel, depth, shade(look, rays, pixel, hit));
        }
    }
}
