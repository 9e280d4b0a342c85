// Additional flat varyings of proxies without patches: the inputs of clipping and searching.
#ifndef TREE_VARYINGS_GLSL
#define TREE_VARYINGS_GLSL
#include "stage/varyings.glsl"

layout(location = 11) flat VARYING vec4 tree_bounds;
layout(location = 12) flat VARYING vec4 tree_axis; // OUTPUT_DEPTH: z is the instance's index
#if READS_MAP
layout(location = 13) flat VARYING vec4 tree_map;
#endif
#if TAKES_STEPS
layout(location = 14) flat VARYING vec4 tree_offset;
#endif
#if READS_TABLES
layout(location = 15) flat VARYING uvec4 tree_patches;
#endif
#if READS_TABLES && !TAKES_STEPS
layout(location = 13) flat VARYING vec2 tree_span; // range of t outside which no ray has a hit
#endif

#ifdef VERTEX_GLSL
void hand_over_tree(vec2 span)
{
#if READS_TABLES && !TAKES_STEPS
    tree_span = span;
#endif
    tree_bounds = object.bounds;
    tree_axis = OUTPUT == OUTPUT_DEPTH ? vec4(object.axis.xy, float(instance_number), 0.0) : object.axis;
#if READS_MAP
    tree_map = object.map;
#endif
#if TAKES_STEPS
    tree_offset = object.offset;
#endif
#if READS_TABLES
    tree_patches = object.patches;
#endif
}
#else
vec2 span_of_rays()
{
#if READS_TABLES && !TAKES_STEPS
    return tree_span;
#else
    return EVERYWHERE;
#endif
}

void take_over_tree()
{
#if OUTPUT == OUTPUT_DEPTH && REPEATED
    take_object(instances[uint(tree_axis.z)].object.x);
#endif
    object.bounds = tree_bounds;
    object.axis = tree_axis;
#if READS_MAP
    object.map = tree_map;
#endif
#if TAKES_STEPS
    object.offset = tree_offset;
#endif
#if READS_TABLES
    object.patches = tree_patches;
    place_own_tables();
#endif
}
#endif

#endif
