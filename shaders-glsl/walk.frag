#version 450
#extension GL_GOOGLE_include_directive : require
// Traces a fragment: the nearest copy of a hierarchy.
#define SINGLE
#define CLIP_DEPTHS
#include "core/look.glsl"
#include "stage/walk.glsl"
#include "stage/walk_varyings.glsl"
#include "stage/outputs.glsl"

layout(depth_greater) out float gl_FragDepth;

void main()
{
    vec2 pixel = gl_FragCoord.xy - 0.5; // of the sample, where each has a ray
    load_frame(walk_root.y);
    load_grid();
    Nearest nearest = nothing_nearer_than(2.0); // behind everything
    TileWalk tile = TileWalk(first_copies, goes_on.x, goes_on.y, uintBitsToFloat(goes_on.z), 0.0);
    walk(walk_root.x, pixel, tile, nearest);
    count_steps(pixel, nearest.hit.steps, nearest.hit.exhausted);
    if (!nearest.found) {
        discard;
    }
    Instance i = instance_at(nearest.index);
    load(i);
    gl_FragDepth = draw(look_of(i, nearest.index), pixel_rays(i), pixel, nearest.hit, lagging_terms(i.lag));
}
