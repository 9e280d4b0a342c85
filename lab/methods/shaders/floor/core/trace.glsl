// What takes the place of the renderer's searches: a ray hits where it enters the box, the height range and the
// bounding cylinder of a solid.
#ifndef TRACE_GLSL
#define TRACE_GLSL
#include "core/hit.glsl"
#include "core/pixel_ray.glsl"
#include "search/quadric.glsl"

bool hit_at(vec3 o, vec3 v, float t, out Hit hit)
{
    hit = NO_HIT;
    hit.t = t;
    hit.point = o + t * v;
    hit.normal = vec3(hit.point.xy, 0.0);
    return true;
}

bool trace(vec3 eye, vec3 v, float base, inout RayStart start, out Hit hit)
{
    hit = NO_HIT;
    Meridian m;
    // Vertices hand over whether there are patches, and fragments must take what they are handed.
    bool meets = clip_ray(eye, v, base, frame_block.ray_start - base, m);
    return meets && shape.table_fact_2 != 0u && hit_at(eye, v, m.t_start, hit);
}

#endif
