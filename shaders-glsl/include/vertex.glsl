// The vertices' half of varyings.glsl.
#ifndef VERTEX_GLSL
#define VERTEX_GLSL
#define VARYING out
#include "varyings.glsl"

void hand_over(Instance i, uint index, float base)
{
    PixelRays rays = pixel_rays(i);
    Look look = look_of(i);
    instance_index = index;
    ray_eye = vec4(rays.eye, base);
    ray_dir_00 = vec4(rays.dir_00, frame.dir_00.w);
    ray_dir_x = vec4(rays.dir_x, frame.dir_x.w);
    ray_dir_y = vec4(rays.dir_y, frame.dir_y.w);
    look_scale_shininess = look.scale_shininess;
    look_albedo_strength = look.albedo_strength;
    look_ambient = look.ambient;
    if (LIGHTS > 0u) {
        look_light_0 = vec4(look.lights[0].towards.xyz, look.lights[0].color.r);
        look_colors = look.lights[0].color.gbgb;
    }
    if (LIGHTS > 1u) {
        look_light_1 = vec4(look.lights[1].towards.xyz, look.lights[1].color.r);
        look_colors.zw = look.lights[1].color.gb;
    }
}

#endif
