#version 450
#extension GL_GOOGLE_include_directive : require
// Shades a pixel of a mesh: colour; the depth is the rasteriser's.
#include "include/mesh_varyings.glsl"

layout(location = 0) out vec4 color;

void main()
{
    solid = batch_solid;
    uvec2 pixel = uvec2(gl_FragCoord.xy);
    Instance i = batch_instance(instance_index);
    PixelRays rays = pixel_rays(i);
    color = shade(i, rays, pixel, mesh_hit(rays, pixel)).color;
}
