// Rays of an instance's pixels in object space. A ray's direction is affine in the pixel position and not normalised,
// so `t` is the depth along the camera's forward axis in every space.
//
// Rays begin in the plane at depth `base`, not at the eye. The plane contains the box's middle, or the eye if the
// middle is behind it. From a far eye, rounding errors of a direction would grow to more than a pixel at the box. The
// CPU computes the point of pixel (0, 0) in this plane in double precision. `t` is zero in the plane and -base at the
// eye.
#ifndef PIXEL_RAY_GLSL
#define PIXEL_RAY_GLSL
#include "core/placement.glsl"


struct PixelRays {
    vec3 origin; // pixel (0, 0), relative to the axis at z = 0
    float base;
    vec3 dir_00; // through pixel (0, 0)
    vec3 dir_x;
    vec3 dir_y;
};

PixelRays pixel_rays(Instance i)
{
    PixelRays rays;
    rays.origin = i.origin;
    rays.base = max(i.depth, 0.0);
    rays.dir_00 = direction_to_object(i, frame.dir_00);
    rays.dir_x = direction_to_object(i, frame.dir_x);
    rays.dir_y = direction_to_object(i, frame.dir_y);
    return rays;
}

// Returns the ray's origin in the plane at depth `base`. `pixel`: distance from the centre of pixel (0, 0).
vec3 ray_origin(PixelRays rays, vec2 pixel)
{
    float spread = ORTHO != 0u ? 1.0 : rays.base;
    return rays.origin + spread * (pixel.x * rays.dir_x + pixel.y * rays.dir_y);
}

vec3 ray_direction(PixelRays rays, vec2 pixel)
{
    if (ORTHO != 0u) {
        return rays.dir_00;
    }
    return rays.dir_00 + pixel.x * rays.dir_x + pixel.y * rays.dir_y;
}

// Returns the `t` at which the ray `o + t v` is nearest to a point of the axis. `weights`: of squared distances.
float nearest_to(vec3 o, vec3 v, float height, vec3 weights)
{
    vec3 weighted = v * weights;
    return dot(vec3(0.0, 0.0, height) - o, weighted) / dot(v, weighted);
}

// Returns weights by which a ray is nearest to the axis, or in a flat or wide box to its middle.
vec3 weights_of_middle()
{
    return vec3(1.0, 1.0, 0.25 * shape.half_side * shape.half_side);
}

// Returns the width of a pixel at depth `t`, in units of depth.
float pixel_width(float t)
{
    return ORTHO != 0u ? frame.pixel_size : frame.pixel_size * t;
}

// The two terms of depths in clip space: depth_constant and depth_factor.
vec2 depth_terms()
{
    return vec2(frame.depth_constant, frame.depth_factor);
}

// Returns the terms of a copy with this lag.
vec2 lagging_terms(float lag)
{
    return depth_terms() + lag * frame_block.lag_depth;
}

// Returns the depth of `t` in clip space, 0 to 1.
float clip_depth_of(float t, vec2 terms)
{
    return clamp(terms.x + (ORTHO != 0u ? terms.y * t : terms.y / t), 0.0, 1.0);
}

float clip_depth_of(float t)
{
    return clip_depth_of(t, depth_terms());
}

// Returns the depth buffer value of a depth in clip space: in the depth range of the viewport. At the far plane and
// beyond, where nothing is drawn, it is the buffer's end that is far.
float buffer_depth_of(float clip)
{
    return mix(depth_window.x + depth_window.y * clip, clip, clip == depth_window.z);
}

// Returns the depth buffer value of `t`.
float depth_of(float t, vec2 terms)
{
    return buffer_depth_of(clip_depth_of(t, terms));
}

float depth_of(float t)
{
    return depth_of(t, depth_terms());
}

#endif
