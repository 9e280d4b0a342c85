// Intersects a pixel's ray with the listed patches of its tile, without branches. The invocations of a group share the
// loads of instance and patches, because lavapipe 22 reads storage buffers lane by lane. Each loads the record: another
// barrier costs lavapipe 25 an eighth of the time.
#ifndef LISTED_GLSL
#define LISTED_GLSL
#extension GL_EXT_control_flow_attributes : require
#include "stage/tile.glsl"
#include "search/patch_row.glsl"

// An instance and its object as words, and the place of both in memory that the group shares. Software drivers read
// storage buffers lane by lane, and shared memory at constant places once for all lanes.
const uint INSTANCE_WORDS = 20u;
const uint OBJECT_WORDS = 48u;
const uint OBJECT_STRIDE_WORDS = 64u;
layout(set = 0, binding = 2, std430) readonly buffer InstanceWords {
    uint instance_words[];
};
layout(set = 0, binding = 1, std430) readonly buffer ObjectWords {
    uint object_words[];
};
shared uint shared_words[INSTANCE_WORDS + OBJECT_WORDS];
shared float listed[8u * LONGEST_LIST];

// Loads the tile's instance, object and patches into shared memory, from which take_shared() reads after a barrier.
void share_tile()
{
    uint self = gl_LocalInvocationIndex;
    uint instance = INSTANCE_WORDS * tile_record.y;
    if (ONE_OBJECT != 2u && self < INSTANCE_WORDS) {
        shared_words[self] = instance_words[instance + self];
    }
    if (ONE_OBJECT == 0u && self < OBJECT_WORDS) {
        shared_words[INSTANCE_WORDS + self] = object_words[OBJECT_STRIDE_WORDS * instance_words[instance + 16u] + self];
    }
    object.parts.z = instance_words[instance + 18u] - (OWN_TABLES ? object.parts.w : 0u);
    uint none = listed_word(0u, 0u);
    uint runs = tile_record.z;
    [[unroll]] for (uint j = 0u; j < 8u * LIST_LENGTH; j += GROUP_PIXELS * GROUP_PIXELS) {
        uint at = j + self;
        if (at < 8u * LIST_LENGTH) {
            uint number = at >> 3;
            uint lower = runs >> 9 & 63u;
            uint k = number < lower ? (runs & 511u) + number : (runs >> 15 & 511u) + number - lower;
            k = number < lower + (runs >> 24) ? k : none;
            listed[at] = uintBitsToFloat(listed_word(1u + 3u * k + (at >> 2 & 1u), at & 3u));
        }
    }
}

uvec4 shared_vector(uint n)
{
    uint at = 4u * n;
    return uvec4(shared_words[at], shared_words[at + 1u], shared_words[at + 2u], shared_words[at + 3u]);
}

void take_shared_object()
{
    object.map = uintBitsToFloat(shared_vector(5u));
    object.bounds = uintBitsToFloat(shared_vector(6u));
    object.offset = uintBitsToFloat(shared_vector(7u));
    object.axis = uintBitsToFloat(shared_vector(8u));
    object.albedo = uintBitsToFloat(shared_vector(9u));
    object.specular = uintBitsToFloat(shared_vector(10u));
    object.texturing = uintBitsToFloat(shared_vector(11u));
    object.cells = shared_vector(12u);
    object.instances = shared_vector(13u);
    object.patches = shared_vector(14u);
    object.parts = shared_vector(15u);
}

void take_shared()
{
    if (ONE_OBJECT == 2u) {
        tile_instance = instances[pushed.instance];
    } else {
        tile_instance.position_sx = uintBitsToFloat(shared_vector(0u));
        tile_instance.rotation = uintBitsToFloat(shared_vector(1u));
        tile_instance.scale_depth = uintBitsToFloat(shared_vector(2u));
        tile_instance.origin = uintBitsToFloat(shared_vector(3u));
        tile_instance.object = shared_vector(4u);
    }
    if (ONE_OBJECT == 0u) {
        take_shared_object();
    }
    take_level(tile_instance);
}

vec4 listed_vector(uint n)
{
    return vec4(listed[4u * n], listed[4u * n + 1u], listed[4u * n + 2u], listed[4u * n + 3u]);
}

bool search_listed(uvec2 pixel, out Hit hit)
{
    PatchRow row = begin_row(tile_rays, pixel);
    // The lists contain no tile with a ray that is in the solid before it enters the box: see tile_lists.comp.
    if (!is_outside()) {
        clip_to_sides(row);
    }
    [[unroll]] for (uint k = 0u; k < LIST_LENGTH; ++k) {
        take_nearer(row.m, listed_vector(2u * k), listed_vector(2u * k + 1u), row.least, row.best, row.quadric);
    }
    return end_row(row, LIST_LENGTH, hit);
}

#endif
