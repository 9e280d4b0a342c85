// What a mesh hands its fragments, and the hit that the rasteriser has found there.
#ifndef MESH_VARYINGS_GLSL
#define MESH_VARYINGS_GLSL
#include "fragment.glsl"

layout(location = 11) in vec4 surface; // x, y about the axis; normal (r, z)

// `point` is dead code where nothing textured is drawn; as a varying it would be interpolated all the same.
Hit mesh_hit(uvec2 pixel)
{
    take_over();
    PixelRays rays = varying_rays();
    Hit hit;
    hit.t = 1.0 / gl_FragCoord.w;
    float inverse_r = inversesqrt(max(dot(surface.xy, surface.xy), 1e-30));
    hit.normal = vec3(surface.xy * (inverse_r * surface.z), surface.w);
    hit.point = rays.eye + hit.t * ray_direction(rays, pixel);
    hit.sense = vec3(1.0);
    hit.steps = 0u;
    hit.exhausted = false;
    return hit;
}

#endif
