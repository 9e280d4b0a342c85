// From world to object and back: world = position + rotate(q, scale * object).
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
    return vec3(i.position_sx.w, i.scale_yz.xy);
}

vec3 point_to_world(Instance i, vec3 p)
{
    return i.position_sx.xyz + rotate(i.rotation, scale_of(i) * p);
}

// Of a point; the result is relative to the axis of revolution at z = 0.
vec3 point_to_axis(Instance i, vec3 p)
{
    return rotate(conjugate(i.rotation), p - i.position_sx.xyz) / scale_of(i) - vec3(solid.axis.xy, 0.0);
}

vec3 direction_to_object(Instance i, vec3 d)
{
    return rotate(conjugate(i.rotation), d) / scale_of(i);
}

#endif
