// Additional varyings of cells: the patches of the cell.
#ifndef CELL_VARYINGS_GLSL
#define CELL_VARYINGS_GLSL
#include "stage/varyings.glsl"

layout(location = 12) flat VARYING vec4 cell_quadric[PATCHES_PER_CELL];
layout(location = 20) flat VARYING vec4 cell_guard[PATCHES_PER_CELL];

#endif
