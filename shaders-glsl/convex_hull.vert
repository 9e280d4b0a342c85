#version 450
#extension GL_GOOGLE_include_directive : require
// The convex hull of each instance, for searches on the map: fragments are where rays enter it.
#include "stage/vertex.glsl"
#include "stage/box_varyings.glsl"
#include "stage/frusta.glsl"

void main()
{
    Instance i = begin(uint(gl_InstanceIndex));
    gl_Position = clip_of(i, frustum_corner(this_frustum()));
    // Its corners stand out of the box, beyond which the far plane may be; no fragment takes its depth from here.
    float sense = frame.forward.w;
    float far = (1.0 - frame.ambient.w) * gl_Position.w;
    gl_Position.z = sense * min(sense * gl_Position.z, sense * far);
    hand_over(i, -frame.dir_00.w);
    hand_over_box();
}
