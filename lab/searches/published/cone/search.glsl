// Cone step mapping: the walk of cone_rows.glsl from either side of the surface.
#include "cone/cone_rows.glsl"

uint search(Meridian m, float side, inout float s, inout uint steps, out vec4 quadric)
{
    return search_cone(m, side, s, steps, quadric);
}
