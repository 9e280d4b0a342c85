// Compute visits bins: squares of the screen that at least one of a batch's boxes covers, with the list of those boxes.
// Work groups count along x within a bin, along y from bin to bin.
#ifndef BINS_GLSL
#define BINS_GLSL
#define SPANS (SEARCH == SEARCH_LIVE && DISPATCH == DISPATCH_BEAMS)
#include "stage/beams.glsl"
#include "stage/pixel_words.glsl"
#include "core/cells.glsl"
#include "core/shade.glsl"

const bool SINGLE = DISPATCH != DISPATCH_BINS;

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
    take_frame();
    take_solid();
    if (SINGLE) {
        single_look = look_of(solid.single);
        single_rays = pixel_rays(solid.single);
    }
}

// A single instance needs no bins: the work groups are those of its rectangle.
Bin this_bin()
{
    if (DISPATCH == DISPATCH_BEAMS) {
        uint at = pushed.first_bin + 4u + 4u * gl_WorkGroupID.x;
        return Bin(bin_words[at], bin_words[at + 1u], bin_words[at + 2u], 0u);
    }
    if (SINGLE) {
        return Bin(pushed.corner, 0u, 1u, 0u);
    }
    uint at = 4u * (pushed.first_bin + gl_WorkGroupID.y);
    return Bin(bin_words[at], bin_words[at + 1u], bin_words[at + 2u], 0u);
}

uvec2 this_pixel(Bin bin)
{
    if (DISPATCH == DISPATCH_BEAMS) {
        return uvec2(bin.corner & 0xffffu, bin.corner >> 16) * GROUP_PIXELS + gl_LocalInvocationID.xy;
    }
    if (SINGLE) {
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
#if DISPATCH == DISPATCH_BINS
    for (uint n = 0u; n < bin.count; ++n)
#else
    const uint n = 0u;
#endif
    {
        uint index = SINGLE ? 0u : bin_words[bin.first + n];
        PixelRays rays = SINGLE ? single_rays : pixel_rays(instances[index]);
        Hit hit;
        bool met;
#if DISPATCH == DISPATCH_BEAMS
        vec2 span = uintBitsToFloat(uvec2(bin.first, bin.count));
#else
        vec2 span = EVERYWHERE;
#endif
#if DISPATCH == DISPATCH_BEAMS && SEARCH == SEARCH_QUADRIC
        met = trace_between(ray_origin(rays, pixel), ray_direction(rays, pixel), span, hit);
#else
        met = trace(ray_origin(rays, pixel), ray_direction(rays, pixel), rays.base, span, hit);
#endif
        nearest.steps += hit.steps;
        nearest.exhausted = nearest.exhausted || hit.exhausted;
        float depth = depth_of(rays.base + hit.t);
        if (met && depth < nearest.depth) {
            found = true;
            nearest.depth = depth;
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
    if (SINGLE) {
        return shade(single_look, nearest.rays, pixel, nearest.hit);
    }
    Instance i = instances[nearest.instance];
    return shade(look_of(i), nearest.rays, pixel, nearest.hit);
}

#endif
