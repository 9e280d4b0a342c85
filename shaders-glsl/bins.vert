#version 450
#extension GL_GOOGLE_include_directive : require
// A rectangle for each run of bins: six vertices, made from the vertex's number.
#define VARYING out
#include "stage/bins_varyings.glsl"
#include "stage/bin_words.glsl"
#include "core/pixel_ray.glsl"

void main()
{
    take_frame();
    take_solid();
    take_lights();
    uint at = 4u * (uint(gl_VertexIndex) / 6u);
    uvec2 x = uvec2(bin_words[at], bin_words[at + 2u]) & 0xffffu;
    uvec2 y = uvec2(bin_words[at], bin_words[at + 2u]) >> 16;
    uint bit = 1u << (uint(gl_VertexIndex) % 6u);
    vec2 pixel = vec2((0x32u & bit) != 0u ? x.y : x.x, (0x2cu & bit) != 0u ? y.y : y.x);
    // No fragment's depth is less.
    float depth = depth_of(max(uintBitsToFloat(bin_words[at + 3u]), 1e-30));
    gl_Position = vec4(pixel * frame.pixels.xz + frame.pixels.yw, depth, 1.0);

    bins_run = uvec2(bin_words[at + 1u], x.x / GROUP_PIXELS);
    bins_dir_00 = frame.dir_00;
    bins_dir_x = frame.dir_x;
    bins_dir_y = frame.dir_y;
    bins_forward = frame.forward;
    bins_ambient = vec4(frame.ambient.rgb, solid.specular.y);
    bins_albedo = vec4(solid.albedo.rgb, solid.specular.x);
    bins_light_0 = vec4(first_light.towards.xyz, first_light.color.r);
    bins_light_1 = vec4(second_light.towards.xyz, second_light.color.r);
    bins_colors = vec4(first_light.color.gb, second_light.color.gb);
    bins_bounds = solid.bounds;
    bins_axis = solid.axis;
#if READS_MAP
    bins_map = solid.map;
#endif
#if TAKES_STEPS
    bins_offset = solid.offset;
#endif
#if READS_TABLES
    bins_patches = solid.patches;
#endif
}
