// Fragment side of varyings.glsl.
#ifndef FRAGMENT_GLSL
#define FRAGMENT_GLSL
#include "stage/varyings.glsl"

// Loads the frame and the solid. Fragments call this first.
void take_over()
{
    take_frame();
#if OUTPUT != OUTPUT_DEPTH
    take_solid(instances[uint(look_ambient.w)].solid.x);
#endif
    frame.dir_00.w = ray_dir_00.w;
    frame.dir_x.w = ray_dir_x.w;
    frame.dir_y.w = ray_dir_y.w;
}

PixelRays varying_rays()
{
    return PixelRays(ray_origin_base.xyz, ray_origin_base.w, ray_dir_00.xyz, ray_dir_x.xyz, ray_dir_y.xyz);
}

#if OUTPUT != OUTPUT_DEPTH
Look varying_look()
{
    Look look;
    look.rotation = look_rotation;
    look.scale_shininess = look_scale_shininess;
    look.albedo_strength = look_albedo_strength;
    look.ambient = look_ambient.rgb;
    look.light_0.towards.xyz = look_light_0.xyz;
    look.light_0.color.rgb = vec3(look_light_0.w, look_colors.xy);
    look.light_1.towards.xyz = look_light_1.xyz;
    look.light_1.color.rgb = vec3(look_light_1.w, look_colors.zw);
#if SHADOWED
    look.position = instances[uint(look_ambient.w)].position_sx.xyz;
#endif
    return look;
}
#endif

#endif
