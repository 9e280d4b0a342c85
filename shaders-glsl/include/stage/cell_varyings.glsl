// Of a hull, besides: the patches of a frustum's cell, and the sides that may cut them.
#ifndef HULL_VARYINGS_GLSL
#define HULL_VARYINGS_GLSL
#include "stage/varyings.glsl"

layout(location = 11) flat VARYING vec4 hull_quadric[PATCHES_PER_CELL];
layout(location = 19) flat VARYING vec4 hull_guard[PATCHES_PER_CELL];
layout(location = 27) flat VARYING vec4 hull_sides; // of the box, from the axis: low x and y, high x and y

#endif
