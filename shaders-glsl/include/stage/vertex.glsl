// Vertex side of varyings.glsl.
#ifndef VERTEX_GLSL
#define VERTEX_GLSL
#define VARYING out
#include "stage/varyings.glsl"

// Index of this vertex's instance among all.
uint instance_number;

// Loads frame and object and returns instance `number`. Vertex shaders call this first.
Instance begin(uint number)
{
    instance_number = number;
    Instance i = instances[number];
    load_frame(i.object);
    load(i);
    return i;
}

// Writes the varyings of varyings.glsl; `scale` becomes ray_dir_00.w.
void hand_over(Instance i, float scale)
{
    PixelRays rays = pixel_rays(i);
    ray_origin_base = vec4(rays.origin, rays.base);
    ray_dir_00 = vec4(rays.dir_00, scale);
    vec2 terms = lagging_terms(i.lag);
    ray_dir_x = vec4(rays.dir_x, terms.x);
    ray_dir_y = vec4(rays.dir_y, terms.y);
    Look look = look_of(i, instance_number);
    look_rotation = look.rotation;
    look_scale_shininess = look.scale_shininess;
    look_albedo_strength = look.albedo_strength;
    look_ambient = vec4(look.ambient, uintBitsToFloat(instance_number | INDEX_BITS));
    look_light_0 = vec4(look.light_0.towards, look.light_0.color.r);
    look_light_1 = vec4(look.light_1.towards, look.light_1.color.r);
    look_colors = vec4(look.light_0.color.gb, look.light_1.color.gb);
    window_record = vec4(depth_window, 0.0);
}

#endif
