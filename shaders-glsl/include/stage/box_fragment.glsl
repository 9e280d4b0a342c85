// Traces a fragment of a shape box, or of a convex hull.
#ifndef BOX_FRAGMENT_GLSL
#define BOX_FRAGMENT_GLSL
#define SPANS (SEARCH == SEARCH_LIVE)
#include "stage/box_varyings.glsl"
#include "stage/fragment.glsl"
#include "core/cells.glsl"

// Depth at which the fragment's ray enters a convex hull. Roundings grow with it, and so does what they are allowed.
float entered()
{
    if (ORTHO != 0) {
        return (gl_FragCoord.z - 1e-4 - frame.dir_x.w) / frame.dir_y.w;
    }
    return (1.0 - 1e-4) / gl_FragCoord.w;
}

bool trace_box(uvec2 pixel, out Hit hit)
{
    take_over();
    take_over_box();
    PixelRays rays = varying_rays();
#if DISPATCH == DISPATCH_BEAMS
    return trace_between(ray_origin(rays, pixel), ray_direction(rays, pixel), box_axis.xy, hit);
#else
    vec2 span = vec2(ray_dir_00.w < 0.0 ? entered() - rays.base : EVERYWHERE.x, EVERYWHERE.y);
    return trace(ray_origin(rays, pixel), ray_direction(rays, pixel), rays.base, span, hit);
#endif
}

#endif
