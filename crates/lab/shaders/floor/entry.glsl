// Where a ray enters the box, the height range and the bounding cylinder of a solid.
#ifndef ENTRY_GLSL
#define ENTRY_GLSL

bool entry_hit(PixelRays rays, uvec2 pixel, out Hit hit)
{
    Meridian m;
    bool found = clip_ray(ray_origin(rays, pixel), ray_direction(rays, pixel), rays.base, m);
    hit.t = m.t_start;
    hit.normal = vec3(m.o.xy, 0.0);
    hit.point = m.o;
    hit.sense = vec3(1.0);
    hit.steps = 0u;
    hit.exhausted = false;
    hit.at_border = false;
    return found;
}

#endif
