// Structures from the vectors of words that buffers hold: members in the order of structures.glsl.
#ifndef WORDS_GLSL
#define WORDS_GLSL
#include "core/structures.glsl"

Instance instance_of(vec4 a, vec4 b, vec4 c, vec4 d, uvec4 e)
{
    return Instance(a.xyz, a.w, b.xyz, b.w, c, d.xyz, d.w, e.x, e.y, e.z, uintBitsToFloat(e.w));
}

Shape shape_of(vec4 a, vec4 b, vec4 c, uvec4 d, uvec4 e, uvec4 f, uvec4 g)
{
    return Shape(a.xy, a.z, a.w, b.x, b.y, b.z, b.w, c.x, c.y, c.z, c.w, uintBitsToFloat(d.xy), d.z, d.w, e.xyz, e.w,
                 f.x, f.y, f.z, f.w, g.x, g.y, g.z, g.w);
}

Appearance appearance_of(uvec4 a, vec4 b, vec4 c, uvec4 d)
{
    return Appearance(uintBitsToFloat(a.xyz), a.w, b.x, b.y, b.z, b.w, c.xy, c.z, c.w, uintBitsToFloat(d.x), d.y,
                      uintBitsToFloat(d.zw));
}

#endif
