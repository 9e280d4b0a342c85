// Of a hull, besides: the pieces of a band's cell.
#ifndef HULL_VARYINGS_GLSL
#define HULL_VARYINGS_GLSL
#include "stage/varyings.glsl"

layout(location = 11) flat VARYING vec4 hull_quadric[HULL_TESTS];
layout(location = 19) flat VARYING vec4 hull_guard[HULL_TESTS];

#endif
