#version 450
#extension GL_GOOGLE_include_directive : require
// Proxies without patches, whose fragments walk the tree: vertices 0 to 13 are the shape box, as a strip that an index
// list unrolls; four more a strip of the box's sides follow, where these cut the solid or a shell of its cells. Why no
// more of the sides is drawn: src/surface/hull.rs.
#include "stage/vertex.glsl"
#include "stage/tree_varyings.glsl"
#include "core/patch_tables.glsl"

const uint BOX_VERTICES = 14u;

vec4 box_corner(Instance i, uint vertex)
{
    vec3 scale = scale_of(i);
    vec3 half_size = vec3(solid.bounds.x, solid.bounds.x, 0.5);
    vec3 forward = rotate(conjugate(i.rotation), frame.forward.xyz) * scale;
    float depth = middle_depth(i);
    float reach = dot(abs(forward), half_size);
    // The ray decides where the box ends; the raster covers a little more, so that it never decides first.
    half_size += 0.05 * frame.dir_00.w * max(depth, reach) / scale + 1e-5;
    // A box that the near plane cuts is drawn by its back faces, at no depth, and so is one around the eye.
    bool inside = depth - dot(abs(forward), half_size) <= frame.clip_y.w;
    uint bit = 1u << vertex;
    vec3 corner = vec3((0x287au & bit) != 0u, (0x02afu & bit) != 0u, (0x31e3u & bit) != 0u) * 2.0 - 1.0;
    corner.x = inside ? -corner.x : corner.x; // mirrored, the faces turn round
    vec4 clip = clip_of(i, corner * half_size + vec3(0.0, 0.0, 0.5));
    clip.z = inside ? frame.ambient.w * clip.w : clip.z;
    return clip;
}

vec4 strip_corner(Instance i, uint vertex)
{
    uint strip = vertex >> 2;
    uint corner = vertex & 3u;
    uint side = strip & 3u;
    vec4 row = uintBitsToFloat(patch_tables[solid.hull.w + (strip >> 2)]); // lowest and highest z, largest radius
    // The axis of the side's normal comes first, the horizontal one second.
    bool along_x = side < 2u;
    float sense = (side & 1u) == 0u ? 1.0 : -1.0;
    float R = solid.bounds.x;
    vec2 axis = along_x ? solid.axis.xy : solid.axis.yx;
    float away = R - sense * axis.x;
    float reach = sqrt(max(row.z * row.z - away * away, 0.0));
    // Wider by so much that the raster never decides first. A row that does not reach the side is nothing.
    vec3 grow = reach > 0.0 ? fraction_of_pixel(i) : vec3(0.0);
    float wider = along_x ? grow.y : grow.x;
    vec2 ends = clamp(axis.y + vec2(-reach, reach), -R, R) + vec2(-wider, wider);
    bool right = corner == 1u || corner == 2u;
    bool turned = along_x == (sense > 0.0);
    vec2 xy = vec2(sense * R, right == turned ? ends.y : ends.x);
    float z = corner >= 2u ? row.y + grow.z : row.x - grow.z;
    vec4 clip = clip_of(i, vec3(along_x ? xy : xy.yx, z));
    // A little nearer, as no hit may be before its triangle. Not outwards: rays along a side would miss its edge.
    clip.z += (frame.clip_x.w != 0.0 ? -1e-5 : 1e-5) * frame.dir_y.w;
    return clip;
}

void main()
{
    Instance i = begin(uint(gl_InstanceIndex));
    uint vertex = uint(gl_VertexIndex);
    if (vertex < BOX_VERTICES) {
        gl_Position = box_corner(i, vertex);
    } else {
        gl_Position = strip_corner(i, vertex - BOX_VERTICES);
    }
    hand_over(i, frame.dir_00.w);
    hand_over_tree(EVERYWHERE);
}
