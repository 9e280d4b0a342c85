#version 450
#extension GL_GOOGLE_include_directive : require
// One invocation a tile of GROUP_PIXELS^2: lists the tiles whose rays may meet the solid, and between which t. The
// list's length becomes the number of work groups of the dispatch that follows.
#include "stage/beams.glsl"
#include "core/patch_tables.glsl"

void main()
{
    take_frame();
    take_solid();
    PixelRays rays = pixel_rays(solid.single);
    uvec2 tile = uvec2(pushed.corner & 0xffffu, pushed.corner >> 16) + gl_GlobalInvocationID.xy;
    vec2 middle = (vec2(tile) + 0.5) * float(GROUP_PIXELS) - 0.5;
    vec3 v = rays.dir_00 + middle.x * rays.dir_x + middle.y * rays.dir_y;

    // At one t the tile's rays are nowhere farther than this from the middle one, in object space.
    vec3 half_size = vec3(solid.bounds.x, solid.bounds.x, 0.5);
    vec3 forward = rotate(conjugate(solid.single.rotation), frame.forward.xyz) * scale_of(solid.single);
    float farthest = rays.base + dot(abs(forward), half_size);
    float spread = 0.5 * float(GROUP_PIXELS) * max(length(rays.dir_x + rays.dir_y), length(rays.dir_x - rays.dir_y));
    float beam = spread * farthest + 1e-4;

    vec3 o = rays.origin + rays.base * (middle.x * rays.dir_x + middle.y * rays.dir_y);
    float a = max(dot(v.xy, v.xy), 1e-12 * dot(v, v));
    float nearest = -dot(o.xy, v.xy) / a;
    float least = max(dot(o.xy, o.xy) - a * nearest * nearest, 0.0);
    float per_z = 1.0 / (abs(v.z) > 1e-20 ? v.z : 1e-20);
    float begin = 1e30;
    float end = -1e30;
    for (uint k = 0u; k < BEAM_NODES; ++k) {
        // Not from the uniform buffer: lavapipe 22 takes uniforms that branches depend on for constants, and crashes
        // over it.
        float most = node_extent(patch_tables[solid.hull.y + (k >> 2)][k & 3u]).y;
        float radius = sqrt(max(most, 0.0)) + beam;
        float low = (float(k) / float(BEAM_NODES) - beam - o.z) * per_z;
        float high = (float(k + 1u) / float(BEAM_NODES) + beam - o.z) * per_z;
        float reach = sqrt(max(radius * radius - least, 0.0) / a);
        float enter = max(min(low, high), nearest - reach);
        float leave = min(max(low, high), nearest + reach);
        bool meets = most > 0.0 && radius * radius > least && enter <= leave;
        begin = meets ? min(begin, enter) : begin;
        end = meets ? max(end, leave) : end;
    }
    if (begin <= end && all(lessThan(tile * GROUP_PIXELS, frame.size.xy))) {
        uint at = pushed.first_bin + 4u + 4u * atomicAdd(bin_words[pushed.first_bin], 1u);
        bin_words[at] = tile.x | tile.y << 16;
        bin_words[at + 1u] = floatBitsToUint(max(begin, -rays.base));
        bin_words[at + 2u] = floatBitsToUint(end);
    }
}
