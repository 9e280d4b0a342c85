// Additional flat varyings of proxies without patches: the inputs of clipping and searching.
#ifndef TREE_VARYINGS_GLSL
#define TREE_VARYINGS_GLSL
#include "stage/varyings.glsl"

layout(location = 11) flat VARYING vec4 tree_bounds;
layout(location = 12) flat VARYING vec2 tree_axis;
layout(location = 13) flat VARYING vec4 tree_map;
layout(location = 14) flat VARYING vec4 tree_offset;
layout(location = 15) flat VARYING uvec4 tree_patches;
layout(location = 16) flat VARYING vec2 tree_span; // range of t outside which no ray has a hit

#ifdef VERTEX_GLSL
void hand_over_tree(vec2 span)
{
    tree_bounds = object.bounds;
    tree_axis = object.axis.xy;
    tree_map = object.map;
    tree_offset = object.offset;
    tree_patches = object.patches;
    tree_span = span;
}
#else
void take_over_tree()
{
    object.bounds = tree_bounds;
    object.axis.xy = tree_axis;
#if READS_MAP
    object.map = tree_map;
#endif
#if TAKES_STEPS
    object.offset = tree_offset;
#endif
#if READS_TABLES
    object.patches = tree_patches;
#endif
}

vec2 span_of_rays()
{
    return SEARCH == SEARCH_QUADRIC ? tree_span : EVERYWHERE;
}
#endif

#endif
