// Flat varyings of every proxy and tile, constant over an instance. Vertex shaders define VARYING as `out`. A pipeline
// leaves out those that its fragments do not read (src/shader/outputs.rs).
#ifndef VARYINGS_GLSL
#define VARYINGS_GLSL
#include "core/look.glsl"
#include "core/pixel_ray.glsl"

#ifndef VARYING
#define VARYING in
#endif

layout(location = 1) flat VARYING vec4 ray_origin_base;
layout(location = 2) flat VARYING vec4 ray_dir_00; // w: pixel_size of the frame; for cells depth_sense
layout(location = 3) flat VARYING vec4 ray_dir_x;  // w: depth_constant, with the copy's lag
layout(location = 4) flat VARYING vec4 ray_dir_y; // w: depth_factor, with the copy's lag
layout(location = 0) flat VARYING vec4 look_rotation;
layout(location = 5) flat VARYING vec4 look_scale_shininess;
layout(location = 6) flat VARYING vec4 look_albedo_strength;
layout(location = 7) flat VARYING vec4 look_ambient; // w: bits of the instance's index, with INDEX_BITS
layout(location = 8) flat VARYING vec4 look_light_0; // xyz: direction to the light; w: red of its colour
layout(location = 9) flat VARYING vec4 look_light_1; // like look_light_0
layout(location = 10) flat VARYING vec4 look_colors; // green and blue of both lights
// xyz: depth_window; w, for cells: bits of the frustum's first vector in patch_tables, with INDEX_BITS
layout(location = 11) flat VARYING vec4 window_record;

const uint INDEX_BITS = 0x40000000u; // make an index below 2^29 a normal float; a device may flush others to zero

#ifndef VERTEX_GLSL
uint varying_instance()
{
    return floatBitsToUint(look_ambient.w) & ~INDEX_BITS;
}

// Loads the frame and the object. Fragments call this first.
void load_varyings()
{
    Instance i = instances[varying_instance()];
    load_frame(i.object);
    load(i);
    frame.pixel_size = ray_dir_00.w;
    frame.depth_constant = ray_dir_x.w;
    frame.depth_factor = ray_dir_y.w;
    depth_window = window_record.xyz;
}

PixelRays varying_rays()
{
    return PixelRays(ray_origin_base.xyz, ray_origin_base.w, ray_dir_00.xyz, ray_dir_x.xyz, ray_dir_y.xyz);
}

Look varying_look()
{
    Look look;
    look.rotation = look_rotation;
    look.scale_shininess = look_scale_shininess;
    look.albedo_strength = look_albedo_strength;
    look.ambient = look_ambient.rgb;
    look.light_0.towards = look_light_0.xyz;
    look.light_0.color = vec3(look_light_0.w, look_colors.xy);
    look.light_1.towards = look_light_1.xyz;
    look.light_1.color = vec3(look_light_1.w, look_colors.zw);
    look.instance = varying_instance();
    look.position = instances[look.instance].position;
    return look;
}
#endif

#endif
