#version 450
#extension GL_GOOGLE_include_directive : require
// Lists, for each of a batch's bins of one copy, the patches that its rays may meet. One invocation a bin.
#include "stage/patch_runs.glsl"
#include "stage/beam.glsl"

void main()
{
    take_frame();
    take_solid();
    uint n = gl_WorkGroupID.x * GROUP_PIXELS * GROUP_PIXELS + gl_LocalInvocationIndex;
    if (n >= pushed.list) {
        return;
    }
    uint bin = 4u * (pushed.corner + n);
    uvec2 corner = uvec2(bin_words[bin] & 0xffffu, bin_words[bin] >> 16);
    Instance instance = instances[bin_words[bin_words[bin + 1u]]];
    PixelRays rays = pixel_rays(instance);
    // Not from the uniform buffer: lavapipe 22 takes uniforms that loops depend on for constants.
    uvec2 header = patch_tables[solid.hull.z].xy;
    Beam beam = beam_of(rays, corner, GROUP_PIXELS, farthest_of(rays, instance), uintBitsToFloat(header.y));
    PatchRuns runs = NO_PATCHES;
    for (uint k = 0u; k < header.x; ++k) {
        vec2 unused;
        take_patch(runs, k, may_meet(beam, k, unused));
    }
    uvec2 lengths = lengths_of(runs);
    if (runs.any && lengths.x + lengths.y <= LONGEST_LIST) {
        append_patches(bin, runs, lengths);
    } else if (runs.any) {
        uint at = pushed.first_bin + 4u + 4u * atomicAdd(bin_words[pushed.first_bin + 1u], 1u);
        for (uint word = 0u; word < 4u; ++word) {
            bin_words[at + word] = bin_words[bin + word];
        }
    }
}
