#version 450
#extension GL_GOOGLE_include_directive : require
// A shape box of each instance: a strip of 14 vertices, made from the vertex's number.
#include "stage/vertex.glsl"
#include "stage/box_varyings.glsl"

void main()
{
    Instance i = begin(uint(gl_InstanceIndex));
    vec3 scale = scale_of(i);
    vec3 half_size = vec3(solid.bounds.x, solid.bounds.x, 0.5);
    vec3 forward = rotate(conjugate(i.rotation), frame.forward.xyz) * scale;
    float depth = middle_depth(i);
    float reach = dot(abs(forward), half_size);

    // The ray decides where the box ends; the raster covers a little more, so that it never decides first.
    half_size += 0.05 * frame.dir_00.w * max(depth, reach) / scale + 1e-5;
    // A box that the near plane cuts is drawn by its back faces, at no depth, and so is one around the eye.
    bool inside = depth - dot(abs(forward), half_size) <= frame.clip_y.w;

    uint bit = 1u << gl_VertexIndex;
    vec3 corner = vec3((0x287au & bit) != 0u, (0x02afu & bit) != 0u, (0x31e3u & bit) != 0u) * 2.0 - 1.0;
    corner.x = inside ? -corner.x : corner.x; // mirrored, the faces turn round
    gl_Position = clip_of(i, corner * half_size + vec3(0.0, 0.0, 0.5));
    gl_Position.z = inside ? frame.ambient.w * gl_Position.w : gl_Position.z;

    hand_over(i, frame.dir_00.w);
    hand_over_box();
}
