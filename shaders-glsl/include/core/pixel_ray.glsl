// The rays of an instance's pixels in object space. A ray's direction is affine in the pixel and is not normalised, so that
// `t` is the depth along the camera's forward axis in every space.
#ifndef PIXEL_RAY_GLSL
#define PIXEL_RAY_GLSL
#include "core/placement.glsl"

struct PixelRays {
    vec3 eye;    // relative to the axis at z = 0
    vec3 dir_00; // through pixel (0, 0)
    vec3 dir_x;
    vec3 dir_y;
};

PixelRays pixel_rays(Instance i)
{
    PixelRays rays;
    rays.eye = point_to_axis(i, frame.eye.xyz);
    rays.dir_00 = direction_to_object(i, frame.dir_00.xyz);
    rays.dir_x = direction_to_object(i, frame.dir_x.xyz);
    rays.dir_y = direction_to_object(i, frame.dir_y.xyz);
    return rays;
}

// From the eye, or from the plane of parallel rays.
vec3 ray_origin(PixelRays rays, uvec2 pixel)
{
    if (ORTHO != 0) {
        return rays.eye + float(pixel.x) * rays.dir_x + float(pixel.y) * rays.dir_y;
    }
    return rays.eye;
}

vec3 ray_direction(PixelRays rays, uvec2 pixel)
{
    if (ORTHO != 0) {
        return rays.dir_00;
    }
    return rays.dir_00 + float(pixel.x) * rays.dir_x + float(pixel.y) * rays.dir_y;
}

// A pixel's width at t, in units of t.
float pixel_width(float t)
{
    return ORTHO != 0 ? frame.dir_00.w : frame.dir_00.w * t;
}

float depth_of(float t)
{
    return clamp(frame.dir_x.w + (ORTHO != 0 ? frame.dir_y.w * t : frame.dir_y.w / t), 0.0, 1.0);
}

#endif
