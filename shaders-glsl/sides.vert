#version 450
#extension GL_GOOGLE_include_directive : require
// The strips of a box's four sides on which the solid, or a shell of its hull, may be cut. Of every row and side one is
// solid throughout (CUT_SOLID), and two beside it may be; six vertices each. Why no more of the sides is drawn:
// src/surface/hull.rs.
#include "stage/vertex.glsl"
#include "stage/box_varyings.glsl"
#include "core/patch_tables.glsl"

void main()
{
    Instance i = begin(uint(gl_InstanceIndex));
    uint strip = uint(gl_VertexIndex) / 6u;
    uint bit = 1u << uint(gl_VertexIndex) % 6u;
    uint beside = CUT == CUT_SOLID ? 0u : strip & 1u;
    strip = CUT == CUT_SOLID ? strip : strip >> 1;
    uint side = strip & 3u;
    // Lowest and highest z, radii: of all, of what is solid.
    vec4 row = uintBitsToFloat(patch_tables[solid.hull.w + (strip >> 2)]);

    // Of the sides the normal's axis comes first, the horizontal one second.
    bool along_x = side < 2u;
    float sense = (side & 1u) == 0u ? 1.0 : -1.0;
    float R = solid.bounds.x;
    vec2 axis = along_x ? solid.axis.xy : solid.axis.yx;
    float away = R - sense * axis.x;
    vec2 reach = sqrt(max(row.zw * row.zw - away * away, 0.0));
    // By so much that the raster never decides first. What does not reach the side is nothing.
    vec3 grow = reach.x > 0.0 ? fraction_of_pixel(i) : vec3(0.0);
    float wider = along_x ? grow.y : grow.x;
    float within = max(reach.y - wider, 0.0);
    vec2 ends = clamp(axis.y + vec2(-within, within), wider - R, R - wider);
    if (CUT != CUT_SOLID) {
        vec2 outer = clamp(axis.y + vec2(-reach.x, reach.x), -R, R) + vec2(-wider, wider);
        ends = beside == 0u ? vec2(outer.x, ends.x + wider) : vec2(ends.y - wider, outer.y);
    }
    bool right = (0x16u & bit) != 0u;
    bool turned = along_x == (sense > 0.0);
    float across = right == turned ? ends.y : ends.x;
    vec2 xy = vec2(sense * R, across);
    float z = (0x34u & bit) != 0u ? row.y + grow.z : row.x - grow.z;
    gl_Position = clip_of(i, vec3(along_x ? xy : xy.yx, z));
    // A little nearer, as no hit may be before its triangle. Not outwards: along a side, rays by its edge would miss
    // it.
    gl_Position.z += (frame.clip_x.w != 0.0 ? -1e-5 : 1e-5) * frame.dir_y.w;

    hand_over(i, frame.dir_00.w);
    hand_over_box();
}
