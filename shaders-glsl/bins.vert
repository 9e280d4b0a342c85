#version 450
#extension GL_GOOGLE_include_directive : require
// A square of pixels in which several copies may show.
#define VARYING out
#include "stage/bins_varyings.glsl"
#include "stage/square.glsl"

void main()
{
    take_frame();
    take_solid();
    take_lights();
    Square square = this_square();
    place_square(square);

    bins_square = uvec4(square.corner, square.words.xy);
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
