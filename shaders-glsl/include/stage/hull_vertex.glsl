// A vertex of a hull: two rings of corners for every frustum, with what its fragments test.
#ifndef HULL_VERTEX_GLSL
#define HULL_VERTEX_GLSL
#extension GL_EXT_control_flow_attributes : require
#include "stage/vertex.glsl"
#include "stage/hull_varyings.glsl"
#include "stage/frusta.glsl"
#include "core/meridian.glsl"

// The vertex's place in object space.
vec3 place_hull_vertex()
{
    Instance i = begin(uint(gl_InstanceIndex));
    uint at = this_frustum();
    vec3 corner = frustum_corner(at);
    gl_Position = clip_of(i, corner);
    hand_over(i, frame.forward.w);
    hull_sides = sides_of_box();
    [[unroll]] for (uint k = 0u; k < PATCHES_PER_CELL; ++k) {
        hull_quadric[k] = uintBitsToFloat(patch_tables[at + 1u + 2u * k]);
        hull_guard[k] = uintBitsToFloat(patch_tables[at + 2u + 2u * k]);
    }
    return corner;
}

#endif
