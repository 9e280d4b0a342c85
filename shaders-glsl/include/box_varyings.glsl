// What a shape box hands its fragments.
#ifndef BOX_VARYINGS_GLSL
#define BOX_VARYINGS_GLSL
#include "shade.glsl"

layout(location = 0) flat in uint instance_index;
layout(location = 1) flat in vec3 ray_eye;
layout(location = 2) flat in vec3 ray_dir_00;
layout(location = 3) flat in vec3 ray_dir_x;
layout(location = 4) flat in vec3 ray_dir_y;

PixelRays varying_rays()
{
    return PixelRays(ray_eye, ray_dir_00, ray_dir_x, ray_dir_y);
}

#endif
