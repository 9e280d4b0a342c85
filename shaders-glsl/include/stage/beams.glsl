// What a compute pass is told of the pixels that it visits.
#ifndef BEAMS_GLSL
#define BEAMS_GLSL
#include "core/pixel_ray.glsl"
#define BIN_WORDS
#include "stage/bin_words.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

layout(push_constant) uniform Pushed {
    uint first_bin; // of beams: where their words begin
    uint corner;    // of a single instance's rectangle, in work groups: x | y << 16; of list_copies.comp the first bin
    uint tiles;     // of lists of patches: for how many tiles there is room
    uint list;      // number of the lists' length; of list_copies.comp how many bins there are
} pushed;

#endif
