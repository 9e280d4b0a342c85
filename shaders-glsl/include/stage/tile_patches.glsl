// A pixel of a tile whose patches are listed: these alone, in a straight line.
#ifndef TILE_PATCHES_GLSL
#define TILE_PATCHES_GLSL
#extension GL_EXT_control_flow_attributes : require
#include "stage/patch_lists.glsl"
#include "stage/bins.glsl"

// Where places are constants software drivers read shared memory once for all lanes.
shared float listed[8u * LONGEST_LIST];
shared uint listed_corner;
const uint INSTANCE_WORDS = 16u;
shared float listed_instance[INSTANCE_WORDS]; // where ALONE is set

layout(set = 0, binding = 2, std430) readonly buffer InstanceWords {
    float instance_words[];
};

// Copies where this group's tile is and, of bins of one copy, the copy: to be read after a barrier.
void take_tile()
{
    uint self = gl_LocalInvocationIndex;
    uint tile = bin_words[list_tiles(pushed.list) + 2u * gl_WorkGroupID.x];
    if (ALONE == 0u && self == 0u) {
        listed_corner = tile * GROUP_PIXELS; // both halves
    }
    if (ALONE != 0u && self < INSTANCE_WORDS) {
        listed_corner = bin_words[tile];
        listed_instance[self] = instance_words[INSTANCE_WORDS * bin_words[bin_words[tile + 1u]] + self];
    }
}

uvec2 tile_corner()
{
    return uvec2(listed_corner & 0xffffu, listed_corner >> 16);
}

vec4 instance_vector(uint n)
{
    uint at = 4u * n;
    return vec4(listed_instance[at], listed_instance[at + 1u], listed_instance[at + 2u], listed_instance[at + 3u]);
}

Instance tile_instance()
{
    if (ALONE != 0u) {
        return Instance(instance_vector(0u), instance_vector(1u), instance_vector(2u), instance_vector(3u));
    }
    return solid.single;
}

// The same, and the patches of the tile.
void take_list()
{
    take_tile();
    uint self = gl_LocalInvocationIndex;
    uint at = list_tiles(pushed.list) + 2u * gl_WorkGroupID.x;
    uint none = own_patch_tables[0].x;
    [[unroll]] for (uint j = 0u; j < 8u * LIST_LENGTH; j += GROUP_PIXELS * GROUP_PIXELS) {
        uint place = j + self;
        if (place < 8u * LIST_LENGTH) {
            uint runs = bin_words[at + 1u];
            uint number = place >> 3;
            uint lower = runs >> 9 & 63u;
            uint k = number < lower ? (runs & 511u) + number : (runs >> 15 & 511u) + number - lower;
            k = number < lower + (runs >> 24) ? k : none;
            listed[place] = uintBitsToFloat(own_patch_tables[1u + 3u * k + (place >> 2 & 1u)][place & 3u]);
        }
    }
    barrier();
}

vec4 listed_vector(uint n)
{
    return vec4(listed[4u * n], listed[4u * n + 1u], listed[4u * n + 2u], listed[4u * n + 3u]);
}

bool nearest_in_tile(uvec2 pixel, out Nearest nearest)
{
    vec3 v = ray_direction(single_rays, pixel);
    Meridian m;
    m.v = v;
    m.o = ray_origin(single_rays, pixel);
    m.a = dot(v.xy, v.xy);
    m.b = dot(m.o.xy, v.xy);
    m.c = dot(m.o.xy, m.o.xy);
    float least = -single_rays.base;
    float most = 2e38;
    if (OUTSIDE == 0u) {
        // No ray of the tile was in the solid before the sides: see list.comp.
        vec2 span = between_sides(m.o, v, sides_of_box());
        least = max(least, span.x);
        most = span.y;
    }
    float best = most;
    vec4 quadric = vec4(0.0);
    [[unroll]] for (uint k = 0u; k < LIST_LENGTH; ++k) {
        take_nearer(m, listed_vector(2u * k), listed_vector(2u * k + 1u), least, best, quadric);
    }
    nearest.hit.t = best;
    nearest.hit.normal = quadric_normal(m, best, quadric);
    nearest.hit.point = m.o + best * v;
    nearest.hit.sense = vec3(1.0);
    nearest.hit.steps = LIST_LENGTH;
    nearest.hit.exhausted = false;
    nearest.hit.at_border = false;
    nearest.instance = 0u;
    nearest.steps = LIST_LENGTH;
    nearest.exhausted = false;
    nearest.depth = depth_of(single_rays.base + best);
    return best < most;
}

#endif
