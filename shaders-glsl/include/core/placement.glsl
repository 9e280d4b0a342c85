// Transforms between world axes and object space: world vector = rotate(q, scale * object vector). Positions are
// relative to the eye or to an instance, never to the world's origin.
#ifndef PLACEMENT_GLSL
#define PLACEMENT_GLSL
#include "core/blocks.glsl"

vec3 rotate(vec4 q, vec3 v)
{
    vec3 t = 2.0 * cross(q.xyz, v);
    return v + q.w * t + cross(q.xyz, t);
}

vec4 conjugate(vec4 q)
{
    return vec4(-q.xyz, q.w);
}

// Returns the clip coordinates of a point in object space.
vec4 clip_of(Instance i, vec3 p)
{
    vec3 way = rotate(i.rotation, i.scale * (p - vec3(0.0, 0.0, 0.5)));
    float depth = i.depth + dot(frame.forward, way);
    vec2 xy = vec2(i.clip_x, i.clip_y) + vec2(dot(frame.clip_x, way), dot(frame.clip_y, way));
    bool parallel = frame.parallel != 0.0;
    // This is clip_depth_of of pixel_ray.glsl, times w.
    float z = parallel ? frame.depth_constant + frame.depth_factor * depth : frame.depth_constant * depth + frame.depth_factor;
    return vec4(xy, z, parallel ? 1.0 : depth);
}

// Transforms a point `p`, relative to `origin`, to object space relative to the axis at z = 0. The difference of
// positions is computed first, because it is exactly zero for the instance itself.
vec3 point_to_axis(Instance i, vec3 origin, vec3 p)
{
    return rotate(conjugate(i.rotation), (origin - i.position) + p) / i.scale - vec3(shape.axis, 0.0);
}

vec3 direction_to_object(Instance i, vec3 d)
{
    return rotate(conjugate(i.rotation), d) / i.scale;
}

#endif
