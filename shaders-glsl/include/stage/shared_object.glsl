// The instance and the object of a tile with a single copy, through memory that the group shares. Software drivers read
// storage buffers lane by lane, and shared memory at constant places once for all lanes.
#ifndef SHARED_OBJECT_GLSL
#define SHARED_OBJECT_GLSL
#include "stage/tile.glsl"

layout(set = 0, binding = 2, std430) readonly buffer InstanceWords {
    uint instance_words[];
};
layout(set = 0, binding = 1, std430) readonly buffer ObjectWords {
    uint object_words[];
};
shared uint shared_words[INSTANCE_WORDS + OBJECT_WORDS];

// Loads the tile's instance and object into shared memory, from which load_shared() reads after a barrier. A draw of one
// copy needs neither.
void share_object()
{
    uint self = gl_LocalInvocationIndex;
    if (ONE_OBJECT != 2u && self < INSTANCE_WORDS) {
        shared_words[self] = instance_words[INSTANCE_WORDS * tile.instance + self];
    }
    if (ONE_OBJECT == 0u && self < OBJECT_WORDS) {
        uint object = instances[tile.instance].object;
        shared_words[INSTANCE_WORDS + self] = object_words[OBJECT_STRIDE_WORDS * object + self];
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
                                 origin_clip.xyz, origin_clip.w, places.x, places.y, places.z, uintBitsToFloat(places.w));
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
                                tiling.z, tiling.w, uintBitsToFloat(last.x), last.y, uintBitsToFloat(last.zw));
    }
    load_level(tile_instance);
}

#endif
