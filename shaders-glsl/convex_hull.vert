#version 450
#extension GL_GOOGLE_include_directive : require
// The convex hull of each instance, for searches on the map: fragments are where rays enter it.
#include "include/vertex.glsl"
#include "include/box_varyings.glsl"
#include "include/bands.glsl"

void main()
{
    frame = frame_block;
    solid = batch_solid;
    Instance i = batch_instance(gl_InstanceIndex);
    gl_Position = frame.clip_from_world * vec4(point_to_world(i, band_corner(this_band())), 1.0);
    // Its corners stand out of the box, beyond which the far plane may be; no fragment takes its depth from here.
    gl_Position.z = min(gl_Position.z, gl_Position.w);
    hand_over(i, gl_InstanceIndex, 0.0);
    hand_over_box();
}
