// Compute visits bins: squares of the screen that at least one of a batch's boxes covers, with the list of those boxes.
// Work groups count along x within a bin, along y from bin to bin.
#ifndef BINS_GLSL
#define BINS_GLSL
#include "beams.glsl"
#include "pixel_words.glsl"
#include "shade.glsl"

// Of a single instance.
Look single_look;
PixelRays single_rays;

// A bin: its corner in bins (x | y << 16), where its list begins, how long it is. Of beams: a tile's corner in tiles, bits of its first and
// last t.
struct Bin {
    uint corner;
    uint first;
    uint count;
    uint unused;
};

// The copies of the blocks: before anything else (see blocks.glsl).
void begin()
{
    frame = frame_block;
    solid = batch_solid;
    if (SINGLE != 0u) {
        single_look = look_of(solid.single);
        single_rays = pixel_rays(solid.single);
    }
}

// A single instance needs no bins: the work groups are those of its rectangle.
Bin this_bin()
{
    if (AHEAD != 0u) {
        uint at = pushed.first_bin + 4u + 4u * gl_WorkGroupID.x;
        return Bin(bin_words[at], bin_words[at + 1u], bin_words[at + 2u], 0u);
    }
    if (SINGLE != 0u) {
        return Bin(pushed.corner, 0u, 1u, 0u);
    }
    uint at = 4u * (pushed.first_bin + gl_WorkGroupID.y);
    return Bin(bin_words[at], bin_words[at + 1u], bin_words[at + 2u], 0u);
}

uvec2 this_pixel(Bin bin)
{
    if (AHEAD != 0u) {
        return uvec2(bin.corner & 0xffffu, bin.corner >> 16) * GROUP_PIXELS + gl_LocalInvocationID.xy;
    }
    if (SINGLE != 0u) {
        uvec2 corner = uvec2(bin.corner & 0xffffu, bin.corner >> 16);
        return (corner + gl_WorkGroupID.xy) * GROUP_PIXELS + gl_LocalInvocationID.xy;
    }
    uint group = gl_WorkGroupID.x;
    uint across = BIN_PIXELS / GROUP_PIXELS;
    uvec2 corner = uvec2(bin.corner & 0xffffu, bin.corner >> 16) * BIN_PIXELS;
    return corner + uvec2(group % across, group / across) * GROUP_PIXELS + gl_LocalInvocationID.xy;
}

struct Nearest {
    Hit hit;
    PixelRays rays;
    uint instance;
    float depth;
    uint steps; // of all searches
    bool exhausted; // one of them ran out of steps
};

// The bin's instances in order; of equal depths the first stays, as under the depth test "less".
bool nearest_hit(Bin bin, uvec2 pixel, out Nearest nearest)
{
    bool found = false;
    nearest.depth = DEPTH_TEST != 0u ? uintBitsToFloat(pixel_words[depth_word(pixel)]) : 1.0;
    nearest.steps = 0u;
    nearest.exhausted = false;
    for (uint n = 0u; n < (SINGLE != 0u ? 1u : bin.count); ++n) {
        uint index = SINGLE != 0u ? 0u : bin_words[bin.first + n];
        PixelRays rays = SINGLE != 0u ? single_rays : pixel_rays(instances[index]);
        Hit hit;
        bool met;
        vec2 span = AHEAD != 0u ? uintBitsToFloat(uvec2(bin.first, bin.count)) : EVERYWHERE;
        if (AHEAD != 0u && TABLES) {
            met = trace_between(rays.eye, ray_direction(rays, pixel), span, hit);
        } else {
            met = trace(rays.eye, ray_direction(rays, pixel), span, hit);
        }
        nearest.steps += hit.steps;
        nearest.exhausted = nearest.exhausted || hit.exhausted;
        if (met && depth_of(hit.t) < nearest.depth) {
            found = true;
            nearest.depth = depth_of(hit.t);
            nearest.hit = hit;
            nearest.rays = rays;
            nearest.instance = index;
        }
    }
    return found;
}

void keep_depth(uvec2 pixel, Nearest nearest)
{
    if (DEPTH_KEEP != 0u) {
        pixel_words[depth_word(pixel)] = floatBitsToUint(nearest.depth);
    }
}

Shaded shade_nearest(uvec2 pixel, Nearest nearest)
{
    if (SINGLE != 0u) {
        return shade(solid.single, single_look, nearest.rays, pixel, nearest.hit);
    }
    Instance i = instances[nearest.instance];
    return shade(i, look_of(i), nearest.rays, pixel, nearest.hit);
}

#endif
