#version 450
#extension GL_GOOGLE_include_directive : require
// Traces a pixel of a shape box: every plane.
#include "include/box_fragment.glsl"
#include "include/pixel_words.glsl"

layout(depth_greater) out float gl_FragDepth;
layout(location = 0) out vec4 color;
layout(location = 1) out vec4 normal_distance;
layout(location = 2) out vec4 shading_normal_u;
layout(location = 3) out vec4 albedo_v;

void main()
{
    uvec2 pixel = uvec2(gl_FragCoord.xy);
    Hit hit;
    bool found = trace_box(pixel, hit);
    atomicAdd(pixel_words[second_word(pixel)], hit.steps);
    if (hit.exhausted) {
        atomicOr(pixel_words[second_word(pixel)], EXHAUSTED_BIT);
    }
    if (!found) {
        discard;
    }
    Shaded s = shade_fragment(pixel, hit);
    color = s.color;
    normal_distance = vec4(s.normal, s.distance);
    shading_normal_u = vec4(s.shading_normal, s.uv.x);
    albedo_v = vec4(s.albedo, s.uv.y);
    gl_FragDepth = depth_of(hit.t);
}
