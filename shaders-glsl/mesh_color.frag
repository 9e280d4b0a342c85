#version 450
#extension GL_GOOGLE_include_directive : require
// Shades a pixel of a mesh: colour; the depth is the rasteriser's.
#include "include/mesh_varyings.glsl"

layout(location = 0) out vec4 color;

void main()
{
    uvec2 pixel = uvec2(gl_FragCoord.xy);
    color = shade_fragment(pixel, mesh_hit(pixel)).color;
}
