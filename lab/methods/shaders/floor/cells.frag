#version 450
#extension GL_GOOGLE_include_directive : require
// The floor of cells: each fragment is a hit where its own triangle is. The normal is that of its cell's first
// patch.
#include "stage/varyings.glsl"
#include "search/quadric.glsl"
#include "stage/outputs.glsl"

layout(location = 12) flat in vec4 first_quadric;

layout(depth_greater) out float gl_FragDepth;

void main()
{
    vec2 pixel = gl_FragCoord.xy - 0.5;
    load_varyings();
    PixelRays rays = varying_rays();
    Meridian m;
    m.v = ray_direction(rays, pixel);
    m.o = ray_origin(rays, pixel);
    Hit hit = NO_HIT;
    hit.t = 1.0 / gl_FragCoord.w - rays.base;
    hit.normal = quadric_normal(m, hit.t, first_quadric);
    hit.point = m.o + hit.t * m.v;
    count_steps(pixel, hit.steps, hit.exhausted);
    draw(varying_look(), rays, pixel, hit);
    gl_FragDepth = gl_FragCoord.z; // written, as the search does
}
