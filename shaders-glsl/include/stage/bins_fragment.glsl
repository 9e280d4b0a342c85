// The bin of a fragment, and the nearest hit among its copies.
#ifndef BINS_FRAGMENT_GLSL
#define BINS_FRAGMENT_GLSL
#include "stage/bins_varyings.glsl"
#include "stage/listed.glsl"

void begin()
{
    take_frame();
    take_solid();
    frame.dir_00 = bins_dir_00;
    frame.dir_x = bins_dir_x;
    frame.dir_y = bins_dir_y;
    frame.forward = bins_forward;
    frame.ambient.rgb = bins_ambient.rgb;
    solid.albedo.rgb = bins_albedo.rgb;
    solid.specular.xy = vec2(bins_albedo.w, bins_ambient.w);
    solid.bounds = bins_bounds;
    solid.axis = bins_axis;
    first_light.towards.xyz = bins_light_0.xyz;
    first_light.color.rgb = vec3(bins_light_0.w, bins_colors.xy);
    second_light.towards.xyz = bins_light_1.xyz;
    second_light.color.rgb = vec3(bins_light_1.w, bins_colors.zw);
#if READS_MAP
    solid.map = bins_map;
#endif
#if TAKES_STEPS
    solid.offset = bins_offset;
#endif
#if READS_TABLES
    solid.patches = bins_patches;
#endif
}

bool nearest_hit(uvec2 pixel, out Nearest nearest)
{
    nearest.depth = frame.forward.w > 0.0 ? 1.0 : 0.0;
    nearest.instance = 0u;
    nearest.steps = 0u;
    nearest.exhausted = false;
    uint first = bins_square.z;
    uint count = bins_square.w;
    if ((count & BIN_SPLIT) != 0u) {
        uvec2 away = pixel - bins_square.xy;
        uint at = first + 2u * ((count ^ BIN_SPLIT) * away.y + away.x);
        first += bin_words[at];
        count = bin_words[at + 1u];
    }
    return nearest_listed(first, count, pixel, nearest);
}

#endif
