#version 450
#extension GL_GOOGLE_include_directive : require
// Vertices of shape boxes, whose fragments search the tree: a strip that an index list unrolls.
#include "stage/vertex.glsl"
#include "stage/tree_varyings.glsl"

vec4 box_corner(Instance i, uint vertex)
{
    vec3 scale = i.scale;
    vec3 half_size = vec3(shape.half_side, shape.half_side, 0.5);
    vec3 forward = rotate(conjugate(i.rotation), frame.forward) * scale;
    float depth = i.depth;
    float reach = dot(abs(forward), half_size);
    // The ray test sets the exact border of the box. The rasterized box is slightly larger, so it never clips first.
    half_size += 0.05 * frame.pixel_size * max(depth, reach) / scale + 1e-5;
    // If the near plane cuts the box or the eye is inside it, the back faces are drawn at the near plane's depth.
    bool inside = depth - dot(abs(forward), half_size) <= frame.near;
    uint bit = 1u << vertex;
    vec3 corner = vec3((0x287au & bit) != 0u, (0x02afu & bit) != 0u, (0x31e3u & bit) != 0u) * 2.0 - 1.0;
    corner.x = inside ? -corner.x : corner.x; // mirroring reverses the winding
    vec4 clip = clip_of(i, corner * half_size + vec3(0.0, 0.0, 0.5));
    clip.z = inside ? frame.near_depth * clip.w : clip.z;
    return clip;
}

void main()
{
    Instance i = begin(uint(gl_InstanceIndex));
    gl_Position = box_corner(i, uint(gl_VertexIndex));
    hand_over(i, frame.pixel_size);
    hand_over_tree();
}
