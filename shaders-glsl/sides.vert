#version 450
#extension GL_GOOGLE_include_directive : require
// The strips of a box's four sides on which the solid, or a shell of its hull, may be cut: six vertices each, a strip
// for every row and side. Why no more of the sides is drawn: src/surface/hull.rs.
#include "stage/vertex.glsl"
#include "stage/box_varyings.glsl"
#include "core/patch_tables.glsl"

void main()
{
    Instance i = begin();
    uint side = uint(gl_VertexIndex) / 6u % 4u;
    uint bit = 1u << uint(gl_VertexIndex) % 6u;
    vec3 row = uintBitsToFloat(patch_tables[solid.hull.w + uint(gl_VertexIndex) / 24u].xyz); // lowest and highest z, radius

    // Of the sides the normal's axis comes first, the horizontal one second.
    bool along_x = side < 2u;
    float sense = (side & 1u) == 0u ? 1.0 : -1.0;
    float R = solid.bounds.x;
    vec2 axis = along_x ? solid.axis.xy : solid.axis.yx;
    float away = R - sense * axis.x;
    float reach = sqrt(max(row.z * row.z - away * away, 0.0));
    // By so much that the raster never decides first. What does not reach the side is nothing.
    vec3 grow = reach > 0.0 ? fraction_of_pixel(i) : vec3(0.0);
    grow = along_x ? grow : grow.yxz;
    vec2 ends = vec2(max(axis.y - reach, -R) - grow.y, min(axis.y + reach, R) + grow.y);
    bool right = (0x16u & bit) != 0u;
    bool turned = along_x == (sense > 0.0);
    float across = right == turned ? ends.y : ends.x;
    vec2 xy = vec2(sense * (R + grow.x), across);
    float z = (0x34u & bit) != 0u ? row.y + grow.z : row.x - grow.z;
    gl_Position = clip_of(i, vec3(along_x ? xy : xy.yx, z));

    hand_over(i, frame.dir_00.w);
    hand_over_box();
}
