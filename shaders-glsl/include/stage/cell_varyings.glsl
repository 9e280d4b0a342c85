// Additional varyings of hulls: the patches of a frustum's cell, and the box's sides that may cut them.
#ifndef HULL_VARYINGS_GLSL
#define HULL_VARYINGS_GLSL
#include "stage/varyings.glsl"

layout(location = 11) flat VARYING vec4 hull_quadric[PATCHES_PER_CELL];
layout(location = 19) flat VARYING vec4 hull_guard[PATCHES_PER_CELL];
layout(location = 27) flat VARYING vec4 hull_sides; // box sides relative to the axis: low x, low y, high x, high y

#endif
