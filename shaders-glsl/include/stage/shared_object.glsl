// The instance and the object of a tile, through memory that the group shares. Software drivers read
// storage buffers lane by lane, and shared memory at constant places once for all lanes.
#ifndef SHARED_OBJECT_GLSL
#define SHARED_OBJECT_GLSL
#include "stage/tile.glsl"

layout(set = 0, binding = 2, std430) readonly buffer InstanceWords {
    uint words_of_instances[];
};
layout(set = 0, binding = 1, std430) readonly buffer ObjectWords {
    uint words_of_objects[];
};
shared uint shared_words[INSTANCE_WORDS + OBJECT_WORDS];

// Loads the tile's instance and object into shared memory, from which load_shared() reads after a barrier. A draw of one
// copy needs neither.
void share_object()
{
    uint self = gl_LocalInvocationIndex;
    if (ONE_OBJECT != 2u && self < INSTANCE_WORDS) {
        shared_words[self] = words_of_instances[INSTANCE_WORDS * tile.instance + self];
    }
    if (ONE_OBJECT == 0u && self < OBJECT_WORDS) {
        uint object = instances[tile.instance].object;
        shared_words[INSTANCE_WORDS + self] = words_of_objects[OBJECT_STRIDE_WORDS * object + self];
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

// Reads the shared words.
void load_shared()
{
    if (ONE_OBJECT == 2u) {
        tile_instance = instances[pushed.instance];
    } else {
        tile_instance = instance_of(shared_floats(0u), shared_floats(1u), shared_floats(2u), shared_floats(3u),
                                    shared_vector(4u));
    }
    if (ONE_OBJECT == 0u) {
        // load_level() sets the last members of a shape.
        shape = shape_of(shared_floats(5u), shared_floats(6u), shared_floats(7u), shared_vector(8u), shared_vector(9u),
                         shared_vector(10u), uvec4(0u));
        appearance = appearance_of(shared_vector(12u), shared_floats(13u), shared_floats(14u), shared_vector(15u));
    }
    load_level(tile_instance);
}

#endif
