// The fragments' half of varyings.glsl.
#ifndef FRAGMENT_GLSL
#define FRAGMENT_GLSL
#include "varyings.glsl"
#include "shade.glsl"

// To be called first.
void take_over()
{
    frame = frame_block;
    frame.dir_00.w = ray_dir_00.w;
    frame.dir_x.w = ray_dir_x.w;
    frame.dir_y.w = ray_dir_y.w;
    solid = batch_solid;
}

PixelRays varying_rays()
{
    return PixelRays(ray_eye.xyz, ray_dir_00.xyz, ray_dir_x.xyz, ray_dir_y.xyz);
}

Look varying_look()
{
    Look look;
    look.scale_shininess = look_scale_shininess;
    look.albedo_strength = look_albedo_strength;
    look.ambient = look_ambient;
    if (LIGHTS > 0u) {
        look.lights[0].towards.xyz = look_light_0.xyz;
        look.lights[0].color.rgb = vec3(look_light_0.w, look_colors.xy);
    }
    if (LIGHTS > 1u) {
        look.lights[1].towards.xyz = look_light_1.xyz;
        look.lights[1].color.rgb = vec3(look_light_1.w, look_colors.zw);
    }
    return look;
}

Shaded shade_fragment(uvec2 pixel, Hit hit)
{
    return shade(batch_instance(instance_index), varying_look(), varying_rays(), pixel, hit);
}

#endif
