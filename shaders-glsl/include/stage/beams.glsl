// The words that say which pixels a compute pass visits, and what it is told of them.
#ifndef BEAMS_GLSL
#define BEAMS_GLSL
#include "core/pixel_ray.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

// Bins, four words each; then the lists of instances, to which bins count from the buffer's beginning; then, of batches that take beams: the
// three words of an indirect dispatch, one unused, and four words a tile: its corner, the bits of its first and last t, one unused.
layout(set = 2, binding = 1, std430) buffer BinWords {
    uint bin_words[];
};

layout(push_constant) uniform Pushed {
    uint first_bin; // of beams: where their words begin
    uint corner;    // of a single instance's rectangle, in work groups: x | y << 16
} pushed;

#endif
