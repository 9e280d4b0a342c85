// Of a hull, besides: the patches of a frustum's cell.
#ifndef HULL_VARYINGS_GLSL
#define HULL_VARYINGS_GLSL
#include "stage/varyings.glsl"

layout(location = 11) flat VARYING vec4 hull_quadric[PATCHES_PER_CELL];
layout(location = 19) flat VARYING vec4 hull_guard[PATCHES_PER_CELL];

#endif
