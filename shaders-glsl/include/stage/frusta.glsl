// Frusta of hulls: two rings of HULL_SIDES corners each, a vertex for each corner.
#ifndef FRUSTA_GLSL
#define FRUSTA_GLSL
#include "core/patch_tables.glsl"

// Where the frustum of this vertex stands in the tables.
uint this_frustum()
{
    return solid.hull.x + FRUSTUM_VECTORS * (uint(gl_VertexIndex) / (2u * HULL_SIDES));
}

// The vertex's place in object space.
vec3 frustum_corner(uint at)
{
    uint corner = uint(gl_VertexIndex) % (2u * HULL_SIDES);
    vec4 rings = uintBitsToFloat(patch_tables[at]);
    vec2 rz = corner < HULL_SIDES ? rings.xy : rings.zw;
    float angle = float(corner % HULL_SIDES) * (6.28318530717958648 / float(HULL_SIDES));
    return vec3(rz.x * cos(angle), rz.x * sin(angle), rz.y) + vec3(solid.axis.xy, 0.0);
}

#endif
