// Compute visits bins: squares of the screen that at least one of a batch's boxes covers, with the list of those boxes.
// Work groups count along x within a bin, along y from bin to bin.
#ifndef BINS_GLSL
#define BINS_GLSL
#include "shade.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

// A bin: its corner in bins (x | y << 16), where its list begins, how long it is.
struct Bin {
    uint corner;
    uint first;
    uint count;
    uint unused;
};

// All bins, four words each; then the lists, to which `first` counts from the buffer's beginning.
layout(set = 2, binding = 1, std430) readonly buffer BinWords {
    uint bin_words[];
};

layout(push_constant) uniform Pushed {
    uint first_bin;
    uint corner; // of a single instance's rectangle, in work groups: x | y << 16
} pushed;

// A single instance needs no bins: the work groups are those of its rectangle.
Bin this_bin()
{
    if (SINGLE != 0u) {
        return Bin(pushed.corner, 0u, 1u, 0u);
    }
    uint at = 4u * (pushed.first_bin + gl_WorkGroupID.y);
    return Bin(bin_words[at], bin_words[at + 1u], bin_words[at + 2u], 0u);
}

uvec2 this_pixel(Bin bin)
{
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
bool nearest_hit(Bin bin, uvec2 pixel, float depth, out Nearest nearest)
{
    bool found = false;
    solid = batch_solid;
    nearest.depth = depth;
    nearest.steps = 0u;
    nearest.exhausted = false;
    for (uint n = 0u; n < (SINGLE != 0u ? 1u : bin.count); ++n) {
        uint index = SINGLE != 0u ? 0u : bin_words[bin.first + n];
        PixelRays rays = pixel_rays(batch_instance(index));
        Hit hit;
        bool met = trace(rays.eye, ray_direction(rays, pixel), hit);
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

#endif
