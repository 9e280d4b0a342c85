#version 450
#extension GL_GOOGLE_include_directive : require
// A square of pixels in which one copy may show. Its fragments search that copy as in a box.
#include "stage/vertex.glsl"
#include "stage/box_varyings.glsl"
#include "stage/square.glsl"

void main()
{
    Square square = this_square();
    Instance i = begin(square.words.x);
    place_square(square);
    hand_over(i, frame.dir_00.w);
    hand_over_box();
}
