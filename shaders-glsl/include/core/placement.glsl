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

vec3 scale_of(Instance i)
{
    return vec3(i.position_sx.w, i.scale_depth.xy);
}

// Returns the clip coordinates of a point in object space.
vec4 clip_of(Instance i, vec3 p)
{
    vec3 way = rotate(i.rotation, scale_of(i) * (p - vec3(0.0, 0.0, 0.5)));
    float depth = i.scale_depth.z + dot(frame.forward.xyz, way);
    vec2 xy = vec2(i.scale_depth.w, i.origin.w) + vec2(dot(frame.clip_x.xyz, way), dot(frame.clip_y.xyz, way));
    bool parallel = frame.clip_x.w != 0.0;
    // This is clip_depth_of of pixel_ray.glsl, times w.
    float z = parallel ? frame.dir_x.w + frame.dir_y.w * depth : frame.dir_x.w * depth + frame.dir_y.w;
    return vec4(xy, z, parallel ? 1.0 : depth);
}

// Transforms a point `p`, relative to `origin`, to object space relative to the axis at z = 0. The difference of
// positions is computed first, because it is exactly zero for the instance itself.
vec3 point_to_axis(Instance i, vec3 origin, vec3 p)
{
    return rotate(conjugate(i.rotation), (origin - i.position_sx.xyz) + p) / scale_of(i) - vec3(object.axis.xy, 0.0);
}

vec3 direction_to_object(Instance i, vec3 d)
{
    return rotate(conjugate(i.rotation), d) / scale_of(i);
}

#endif
