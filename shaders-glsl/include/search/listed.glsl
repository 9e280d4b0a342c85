// Intersects a pixel's ray with the listed patches of its tile, without branches. The invocations of a group share the
// loads of instance and patches, because lavapipe 22 reads storage buffers lane by lane. Each loads the tile: another
// barrier costs lavapipe 25 an eighth of the time.
#ifndef LISTED_GLSL
#define LISTED_GLSL
#extension GL_EXT_control_flow_attributes : require
#include "stage/tile.glsl"
#include "search/patch_row.glsl"

// An instance and its object as words, and the place of both in memory that the group shares. Software drivers read
// storage buffers lane by lane, and shared memory at constant places once for all lanes.
const uint INSTANCE_WORDS = 20u;
const uint OBJECT_WORDS = 44u;
const uint OBJECT_STRIDE_WORDS = 64u;
layout(set = 0, binding = 2, std430) readonly buffer InstanceWords {
    uint instance_words[];
};
layout(set = 0, binding = 1, std430) readonly buffer ObjectWords {
    uint object_words[];
};
shared uint shared_words[INSTANCE_WORDS + OBJECT_WORDS];
shared float listed[8u * LONGEST_LIST];

// Loads the tile's instance, object and patches into shared memory, from which load_shared() reads after a barrier.
void share_tile()
{
    uint self = gl_LocalInvocationIndex;
    if (ONE_OBJECT != 2u && self < INSTANCE_WORDS) {
        shared_words[self] = instance_words[INSTANCE_WORDS * tile.instance + self];
    }
    if (ONE_OBJECT == 0u && self < OBJECT_WORDS) {
        uint object = instances[tile.instance].object;
        shared_words[INSTANCE_WORDS + self] = object_words[OBJECT_STRIDE_WORDS * object + self];
    }
    shape.listed = instances[tile.instance].listed - (OWN_TABLES ? shape.listed_window : 0u);
    uint none = listed_word(0u, 0u);
    uint runs = tile.found.x;
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

// Returns vector `n` of the shared words.
uvec4 shared_vector(uint n)
{
    uint at = 4u * n;
    return uvec4(shared_words[at], shared_words[at + 1u], shared_words[at + 2u], shared_words[at + 3u]);
}

vec4 shared_floats(uint n)
{
    return uintBitsToFloat(shared_vector(n));
}

// Reads the shared words: members in the order of structures.glsl.
void load_shared()
{
    if (ONE_OBJECT == 2u) {
        tile_instance = instances[pushed.instance];
    } else {
        vec4 position_depth = shared_floats(0u), scale_clip = shared_floats(1u), origin_clip = shared_floats(3u);
        uvec4 places = shared_vector(4u);
        tile_instance = Instance(position_depth.xyz, position_depth.w, scale_clip.xyz, scale_clip.w, shared_floats(2u),
                                 origin_clip.xyz, origin_clip.w, places.x, places.y, places.z, 0u);
    }
    if (ONE_OBJECT == 0u) {
        vec4 map = shared_floats(5u), clip = shared_floats(6u), offset = shared_floats(7u);
        uvec4 axis = shared_vector(8u), replicas = shared_vector(9u), table = shared_vector(10u);
        shape = Shape(map.xy, map.z, map.w, clip.x, clip.y, clip.z, clip.w, offset.x, offset.y, offset.z, offset.w,
                      uintBitsToFloat(axis.xy), axis.z, axis.w, replicas.xyz, replicas.w, table.x, table.y, table.z, table.w,
                      0u, 0u, 0u, 0u);
        uvec4 color = shared_vector(12u);
        vec4 gloss = shared_floats(13u), tiling = shared_floats(14u);
        uvec4 last = shared_vector(15u);
        appearance = Appearance(uintBitsToFloat(color.xyz), color.w, gloss.x, gloss.y, gloss.z, gloss.w, tiling.xy,
                                tiling.z, tiling.w, uintBitsToFloat(last.x), last.y, 0u, 0u);
    }
    load_level(tile_instance);
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
