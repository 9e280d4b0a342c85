// Buffers of crowds: objects with many copies, whose tiles the device lists.
//
// The passes, in order: crowd_copies.comp projects every copy; crowd_order.comp sorts them into ranges of depth;
// crowd_tiles.comp lists copies in tiles, one range after the other, and marks the pixels that they hide;
// crowd_order.comp sorts the entries of each tile to queues, and makes records and commands.
//
// All counts and lists are in the bins of tiles, from crowd.head on: CROWD_HEAD words, LAYER_HEAD words per layer, then
// the lists at the words that the block names.
#ifndef CROWD_GLSL
#define CROWD_GLSL
#define BIN_WORDS
#define TILE_ACCESS
#include "stage/compute.glsl"
#include "core/pixel_ray.glsl"

// Words of the head.
const uint VISIBLE_GROUPS = 0u; // indirect dispatch over copies that may show; the fourth word is their number
const uint ENTRY_GROUPS = 4u;   // indirect dispatch over entries of tiles; the fourth word is their number
const uint LEAST_NEAR = 8u;     // ~ of the least nearest depth (float bits)
const uint MOST_NEAR = 9u;      // the largest nearest depth (float bits)
const uint STEPS = 140u;         // for each step of depth: number of its copies, then its range
const uint SLICE_GROUPS = 12u;  // for each range of depth, an indirect dispatch over its copies, and their number
// Words of a layer's head.
const uint LAYER_COMMAND = 0u; // indirect draw or dispatch
const uint LAYER_RECORDS = 4u; // number of its records

struct CrowdObject {
    uvec4 axis;    // x, y from the box's middle: two doubles
    vec4 shape;    // the same; radius of the cylinder around it; unused
    vec4 heights;  // lowest and highest z of that cylinder; unused
    uvec4 copies;  // first and end among all copies of crowds; first instance; index of the object
    uvec4 pieces;  // layer; number of outer and of inner pieces; unused
    vec4 outer[CROWD_PIECES]; // cylinders around the solid: radius, low, high
    vec4 inner[CROWD_PIECES]; // cylinders within the solid
};

layout(set = 2, binding = 8, std430) readonly buffer CrowdBlock {
    uvec4 eye[2]; // three doubles each
    uvec4 forward[2];
    uvec4 dir_00[2];
    uvec4 clip_x[2];
    uvec4 clip_y[2];
    vec4 row_x;    // a point over its depth gives its pixel; w: margin, pixels
    vec4 row_y;    // w: lowest pixel position on the x axis, with the margin
    vec4 row_z;    // w: lowest pixel position on the y axis
    vec4 limits;   // highest pixel position on both axes
    ivec4 picture; // first and last pixel: left, top, right, bottom
    uvec4 size;    // tiles across and down; layers; objects
    uvec4 counts;  // copies; most entries; first words of the head and of the cover
    uvec4 lists;   // first word of: counts of tiles; first entries of tiles; visible copies; entries
    uvec4 order;   // first word of: numbers of visible copies by range; depths and numbers of entries by tile; pixels of tiles
    uvec4 tiles;   // in tile_words: first words of records, visible copies and queues; 1: records of pixels, 0: of tiles
    CrowdObject objects_of[];
} crowd;

uint head_word(uint n)
{
    return crowd.counts.z + n;
}

uint layer_word(uint layer, uint n)
{
    return crowd.counts.z + CROWD_HEAD + LAYER_HEAD * layer + n;
}

// Adds one to a counter of an indirect dispatch of groups of 64, and returns its number. `most`: upper limit.
uint count_up(uint head, uint most)
{
    uint number = atomicAdd(bin_words[head + 3u], 1u);
    if (number < most && (number & 63u) == 0u) {
        atomicAdd(bin_words[head], 1u);
        bin_words[head + 1u] = 1u;
        bin_words[head + 2u] = 1u;
    }
    return number;
}

uint tile_count()
{
    return crowd.size.x * crowd.size.y;
}

bool overflows()
{
    return bin_words[head_word(ENTRY_GROUPS + 3u)] > crowd.counts.y;
}

// A copy's axes under the three rows: pixel positions times depth, and depth.
struct Axes {
    vec3 middle; // its axis at z = 0
    vec3 x, y, z;
};

vec3 project(vec3 p)
{
    return vec3(dot(crowd.row_x.xyz, p), dot(crowd.row_y.xyz, p), dot(crowd.row_z.xyz, p));
}

Axes axes_of(Instance i, vec2 axis)
{
    vec3 scale = scale_of(i);
    vec3 x = rotate(i.rotation, vec3(scale.x, 0.0, 0.0));
    vec3 y = rotate(i.rotation, vec3(0.0, scale.y, 0.0));
    vec3 z = rotate(i.rotation, vec3(0.0, 0.0, scale.z));
    vec3 at = i.position_sx.xyz + x * axis.x + y * axis.y;
    return Axes(project(at), project(x), project(y), project(z));
}

int first_pixel(float place)
{
    return int(ceil(clamp(place, -1e6, 1e6) - 0.5));
}

int last_pixel(float place)
{
    return int(floor(clamp(place, -1e6, 1e6) - 0.5));
}

// Returns the depths between which a cylinder lies: radius, low, high.
vec2 depths_of(Axes axes, vec3 cylinder)
{
    vec2 discs = axes.middle.z + axes.z.z * cylinder.yz;
    float deep = cylinder.x * length(vec2(axes.x.z, axes.y.z));
    return vec2(min(discs.x, discs.y) - deep, max(discs.x, discs.y) + deep);
}

// Returns the pixels of a cylinder in front of the eye: left, top, right, bottom. Lines of sight that are tangent to one
// of its discs are roots of a quadratic. The disc's middle is the origin, so that no term cancels.
ivec4 pixels_of(Axes axes, vec3 cylinder)
{
    float margin = crowd.row_x.w;
    float r2 = cylinder.x * cylinder.x;
    vec2 low = vec2(3e38);
    vec2 high = vec2(-3e38);
    for (uint k = 0u; k < 2u; ++k) {
        vec3 disc = axes.middle + axes.z * cylinder[1u + k];
        vec2 at = disc.xy / disc.z;
        vec2 x = axes.x.xy - at * axes.x.z;
        vec2 y = axes.y.xy - at * axes.y.z;
        float a = disc.z * disc.z - r2 * (axes.x.z * axes.x.z + axes.y.z * axes.y.z);
        vec2 b = -r2 * (x * axes.x.z + y * axes.y.z);
        vec2 root = sqrt(b * b + a * r2 * (x * x + y * y));
        low = min(low, at + (b - root) / a);
        high = max(high, at + (b + root) / a);
    }
    low -= margin;
    high += margin;
    ivec4 pixels = ivec4(first_pixel(low.x), first_pixel(low.y), last_pixel(high.x), last_pixel(high.y));
    return ivec4(max(pixels.xy, crowd.picture.xy), min(pixels.zw, crowd.picture.zw));
}

// Returns the word of the step of depth that holds a nearest depth. Steps are equal parts of the range of logarithms.
uint step_word(float near)
{
    float least = max(uintBitsToFloat(~bin_words[head_word(LEAST_NEAR)]), 1e-30);
    float most = max(uintBitsToFloat(bin_words[head_word(MOST_NEAR)]), 1.0001 * least);
    float part = log(max(near, least) / least) / log(most / least);
    return head_word(STEPS + uint(clamp(part * float(CROWD_STEPS), 0.0, float(CROWD_STEPS) - 1.0)));
}

// Returns the range of depth of a nearest depth. Ranges are runs of steps with about as many copies each.
uint slice_of(float near)
{
    return bin_words[step_word(near)];
}

// Returns the number of copies in nearer ranges.
uint before_slice(uint slice)
{
    uint sum = 0u;
    for (uint k = 0u; k < slice; ++k) {
        sum += bin_words[head_word(SLICE_GROUPS + 4u * k + 3u)];
    }
    return sum;
}

#endif
