// Buffers of crowds: objects with many copies, whose tiles the device lists.
//
// The passes, in order: crowd_copies.comp finds the copies in the picture and their rectangles; crowd_order.comp puts
// them in order of depth and makes ranges of about as many copies each; crowd_tiles.comp lists copies in tiles, one range
// after the other, and marks the pixels that they hide; crowd_copies.comp makes the records of the listed copies;
// crowd_order.comp makes the queues of tiles, their records and the commands that draw them.
//
// All counts and lists are in the bins of tiles, from crowd.head on: CROWD_HEAD words, LAYER_HEAD words per layer, then
// the lists at the words that the block names.
#ifndef CROWD_GLSL
#define CROWD_GLSL
#define BIN_WORDS
#define TILE_ACCESS
#include "stage/compute.glsl"
#include "core/pixel_ray.glsl"

// Words of the head. A list is an indirect dispatch over it, in groups of 64, and its number of copies or entries.
const uint VISIBLE = 0u; // copies in the picture
const uint LISTED = 4u;  // copies that are listed in a tile
const uint ENTRIES = 8u; // entries of tiles
const uint RANGES = 12u; // for each range of depth, its copies
const uint RANGE_FIRSTS = RANGES + 4u * CROWD_RANGES; // for each range, the number of copies in nearer ranges
// For each step of depth, the number of its copies; later its next place in the order.
const uint STEPS = RANGE_FIRSTS + CROWD_RANGES;
// Words of a layer's head.
const uint LAYER_COMMAND = 0u; // indirect draw or dispatch
const uint LAYER_RECORDS = 4u; // number of its records

struct CrowdObject {
    uvec4 axis;    // x, y from the box's middle: two doubles
    vec4 shape;    // the same; radius of the cylinder around it; unused
    vec4 heights;  // lowest and highest z of that cylinder; unused
    uvec4 copies;  // first and end among all copies of crowds; first instance; index of the object
    uvec4 pieces;  // layer; number of outer and of inner pieces; the finest level
    vec4 limits;   // limits of the levels of copies
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
    vec4 limits;   // highest pixel position on both axes; factor on nearest depths, below 1
    ivec4 picture; // first and last pixel: left, top, right, bottom
    uvec4 size;    // tiles across and down; layers; objects
    uvec4 counts;  // copies; most entries; first words of the head and of the cover
    // First words of lists of the tiles of all layers: number of entries; ~ of the nearest depth; marked pixels, two
    // words for each tile; first place in the queues.
    uvec4 lists;
    uvec4 copies;  // first words of: copies in the picture; their numbers by depth; those of listed copies; entries
    uvec4 tiles;   // in tile_words: first words of records, listed copies and queues; 1: records of pixels, 0: of tiles
    uvec4 steps;   // step of the nearest copies; rows of groups of a dispatch over pixels; unused
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

// Returns the number of this invocation in a dispatch of groups of 64.
uint invocation()
{
    return 64u * (gl_WorkGroupID.x + GROUPS_ACROSS * gl_WorkGroupID.y) + gl_LocalInvocationIndex;
}

// Adds one to a list of the head, and returns its number. `most`: upper limit.
uint add_to(uint list, uint most)
{
    uint head = head_word(list);
    uint number = atomicAdd(bin_words[head + 3u], 1u);
    if (number < most && (number & 63u) == 0u) {
        uint group = number / 64u;
        atomicMax(bin_words[head], min(group + 1u, GROUPS_ACROSS));
        atomicMax(bin_words[head + 1u], group / GROUPS_ACROSS + 1u);
        bin_words[head + 2u] = 1u;
    }
    return number;
}

uint count_of(uint list)
{
    return bin_words[head_word(list + 3u)];
}

uint tile_count()
{
    return crowd.size.x * crowd.size.y;
}

bool overflows()
{
    return count_of(ENTRIES) > crowd.counts.y;
}

layout(set = 2, binding = 7, std430) readonly buffer Placements {
    uint placement_words[]; // position, unit quaternion, scale: ten doubles each
};
const uint PLACEMENT_WORDS = 20u;

double placed(uint copy, uint n)
{
    uint at = PLACEMENT_WORDS * copy + 2u * n;
    return packDouble2x32(uvec2(placement_words[at], placement_words[at + 1u]));
}

#define TRIPLE(of) dvec3(packDouble2x32(of[0].xy), packDouble2x32(of[0].zw), packDouble2x32(of[1].xy))

// Returns a copy's position relative to the eye.
dvec3 from_eye(uint copy)
{
    return dvec3(placed(copy, 0u), placed(copy, 1u), placed(copy, 2u)) - TRIPLE(crowd.eye);
}

// Returns the first word of a copy in a queue of tile_words.
uint queue_word(uint first, uint place)
{
    return first + QUEUE_WORDS * (place - place % QUEUE_BLOCK) + 2u * (place % QUEUE_BLOCK);
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

vec4 rotation_of(uint copy)
{
    return vec4(placed(copy, 3u), placed(copy, 4u), placed(copy, 5u), placed(copy, 6u));
}

vec3 scale_of(uint copy)
{
    return vec3(placed(copy, 7u), placed(copy, 8u), placed(copy, 9u));
}

Axes axes_of(uint copy, vec2 axis)
{
    vec4 rotation = rotation_of(copy);
    vec3 scale = scale_of(copy);
    vec3 x = rotate(rotation, vec3(scale.x, 0.0, 0.0));
    vec3 y = rotate(rotation, vec3(0.0, scale.y, 0.0));
    vec3 z = rotate(rotation, vec3(0.0, 0.0, scale.z));
    vec3 at = vec3(from_eye(copy)) + x * axis.x + y * axis.y;
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

// Returns the step of a nearest depth (float bits).
uint step_of(uint near)
{
    uint step = near >> CROWD_STEP_SHIFT;
    return min(step - min(step, crowd.steps.x), CROWD_STEPS - 1u);
}

#endif
