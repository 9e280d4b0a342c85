// Additional flat varyings of proxies without patches: the inputs of clipping and searching.
#ifndef TREE_VARYINGS_GLSL
#define TREE_VARYINGS_GLSL
#include "stage/varyings.glsl"

layout(location = 12) flat VARYING vec4 tree_bounds;
layout(location = 13) flat VARYING vec2 tree_axis;
layout(location = 14) flat VARYING vec4 tree_map;
layout(location = 15) flat VARYING vec4 tree_offset;
layout(location = 16) flat VARYING uvec4 tree_table;

#ifdef VERTEX_GLSL
void hand_over_tree()
{
    tree_bounds = vec4(shape.half_side, shape.clip_radius, shape.clip_low, shape.clip_high);
    tree_axis = shape.axis;
    tree_map = vec4(shape.map_size, shape.texel, shape.map_scale);
    tree_offset = vec4(shape.extend, shape.bevel, shape.chamfer, shape.most_steps);
    tree_table = uvec4(shape.table, shape.table_fact_0, shape.table_fact_1, shape.table_fact_2);
}
#else
void load_tree_varyings()
{
    shape.half_side = tree_bounds.x;
    shape.clip_radius = tree_bounds.y;
    shape.clip_low = tree_bounds.z;
    shape.clip_high = tree_bounds.w;
    shape.axis = tree_axis;
#if READS_MAP
    shape.map_size = tree_map.xy;
    shape.texel = tree_map.z;
    shape.map_scale = tree_map.w;
#endif
#if TAKES_STEPS
    shape.extend = tree_offset.x;
    shape.bevel = tree_offset.y;
    shape.chamfer = tree_offset.z;
    shape.most_steps = tree_offset.w;
#endif
#if READS_TABLES
    shape.table = tree_table.x;
    shape.table_fact_0 = tree_table.y;
    shape.table_fact_1 = tree_table.z;
    shape.table_fact_2 = tree_table.w;
#endif
}
#endif

#endif
