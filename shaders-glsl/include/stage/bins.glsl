// Compute visits bins: squares of the screen, or as many pixels from anywhere, in which at least one of a batch's
// copies may show, with lists of these copies. Work groups count along y from bin to bin.
#ifndef BINS_GLSL
#define BINS_GLSL
#define SPANS (SEARCH == SEARCH_LIVE && DISPATCH == DISPATCH_BEAMS)
#include "stage/beams.glsl"
#include "stage/pixel_words.glsl"
#include "stage/listed.glsl"
#include "stage/patch_lists.glsl"
#include "core/shade.glsl"

const bool SINGLE = DISPATCH != DISPATCH_BINS;

// Of a single instance.
Look single_look;
PixelRays single_rays;

// A bin (bin_words.glsl). Of beams: a tile's corner in tiles, bits of its first and last t.
struct Bin {
    uint corner;
    uint first;
    uint count;
    uint unused;
};

void take_single(Instance i)
{
    single_look = look_of(i);
    single_rays = pixel_rays(i);
}

// The copies of the blocks: before anything else (see blocks.glsl).
void begin()
{
    take_frame();
    take_solid();
    take_lights();
#if DISPATCH == DISPATCH_RECTANGLE || DISPATCH == DISPATCH_BEAMS
    take_single(solid.single);
#endif
}

// A single instance needs no bins: the work groups are those of its rectangle, or of the tiles that beams have listed.
Bin this_bin()
{
    if (DISPATCH == DISPATCH_BEAMS || CUT == CUT_TILES) {
        uint at = pushed.first_bin + 4u + 4u * gl_WorkGroupID.x;
        return Bin(bin_words[at], bin_words[at + 1u], bin_words[at + 2u], 0u);
    }
    if (CUT == CUT_SOLID) {
        return Bin(bin_words[list_tiles(pushed.list) + 2u * gl_WorkGroupID.x], 0u, 0u, 0u);
    }
    if (SINGLE) {
        return Bin(pushed.corner, 0u, 1u, 0u);
    }
    uint at = 4u * (pushed.first_bin + gl_WorkGroupID.y);
    return Bin(bin_words[at], bin_words[at + 1u], bin_words[at + 2u], 0u);
}

// The pixel of this invocation. A split bin becomes the one of this pixel.
uvec2 this_pixel(inout Bin bin)
{
    if (DISPATCH == DISPATCH_RECTANGLE && CUT == CUT_ANY) {
        uvec2 corner = uvec2(bin.corner & 0xffffu, bin.corner >> 16);
        return (corner + gl_WorkGroupID.xy) * GROUP_PIXELS + gl_LocalInvocationID.xy;
    }
#if DISPATCH == DISPATCH_BINS
    uint place = bin.corner + (gl_LocalInvocationID.x | gl_LocalInvocationID.y << 16);
    if (bin.count == BIN_SPLIT) {
        uint at = bin.first + 3u * gl_LocalInvocationIndex;
        place = bin_words[at];
        bin.first += bin_words[at + 1u];
        bin.count = bin_words[at + 2u];
    }
    return uvec2(place & 0xffffu, place >> 16);
#else
    return uvec2(bin.corner & 0xffffu, bin.corner >> 16) * GROUP_PIXELS + gl_LocalInvocationID.xy;
#endif
}

bool nearest_hit(Bin bin, uvec2 pixel, out Nearest nearest)
{
    nearest.depth = DEPTH_TEST != 0u ? uintBitsToFloat(pixel_words[depth_word(pixel)]) : 1.0;
    nearest.steps = 0u;
    nearest.exhausted = false;
#if DISPATCH == DISPATCH_BINS
    return nearest_listed(bin.first, bin.count, pixel, nearest);
#else
    nearest.instance = 0u;
    vec3 origin = ray_origin(single_rays, pixel);
    vec3 v = ray_direction(single_rays, pixel);
#if DISPATCH == DISPATCH_BEAMS
    vec2 span = uintBitsToFloat(uvec2(bin.first, bin.count));
#else
    vec2 span = EVERYWHERE;
#endif
#if DISPATCH == DISPATCH_BEAMS && SEARCH == SEARCH_QUADRIC
    bool met = trace_between(origin, v, span, nearest.hit);
#else
    bool met = trace(origin, v, single_rays.base, span, nearest.hit);
#endif
    nearest.steps = nearest.hit.steps;
    nearest.exhausted = nearest.hit.exhausted;
    float depth = depth_of(single_rays.base + nearest.hit.t);
    met = met && depth < nearest.depth;
    nearest.depth = met ? depth : nearest.depth;
    return met;
#endif
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
        return shade(single_look, single_rays, pixel, nearest.hit);
    }
    Instance i = instances[nearest.instance];
    return shade(look_of(i), pixel_rays(i), pixel, nearest.hit);
}

#endif
