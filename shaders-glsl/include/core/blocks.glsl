// Blocks of the frame, of objects and of copies, and the values of the current ones.
#ifndef BLOCKS_GLSL
#define BLOCKS_GLSL
#extension GL_EXT_samplerless_texture_functions : require
#include "core/words.glsl"

layout(set = 0, binding = 0, std140) uniform FrameBlock {
    FrameData frame_block;
};

struct PaddedObject {
    Object object;
    LevelTables levels;
    uvec4 padding[(OBJECT_STRIDE_WORDS - OBJECT_WORDS - LEVEL_WORDS) / 4u];
};

layout(set = 0, binding = 1, std430) readonly buffer ObjectBlock {
    PaddedObject objects[];
};

// The object of a draw or dispatch that has only one.
layout(set = 0, binding = 6, std140) uniform OwnObject {
    Object own_object;
};

#ifndef PLACES
#define INSTANCE_ACCESS readonly
#else
#define INSTANCE_ACCESS writeonly
// The instances as the host wrote them.
layout(set = 0, binding = 11, std430) readonly buffer WrittenBlock {
    Instance written[];
};
#endif
layout(set = 0, binding = 2, std430) INSTANCE_ACCESS buffer InstanceBlock {
    Instance instances[];
};

// Nodes of all hierarchies of copies (src/plan/walk.rs).
layout(set = 0, binding = 3, std430) readonly buffer WalkBlock {
    WalkNode walk_nodes[];
};

layout(set = 0, binding = 2, std430) readonly buffer LastCopyBlock {
    LastCopy last_copies[];
};

// The vectors of the objects, of the instances and of the nodes. Lavapipe reads a storage buffer in a loop over the
// lanes, and such a view without a loop. So it reads these where lanes read different places.
layout(set = 0, binding = 7) uniform utextureBuffer object_texels;
layout(set = 0, binding = 8) uniform utextureBuffer instance_texels;
layout(set = 0, binding = 9) uniform utextureBuffer node_texels;

uvec4 instance_words(uint number, int at)
{
    return texelFetch(instance_texels, int(INSTANCE_WORDS / 4u * number) + at);
}

#ifndef PLACES
Instance instance_at(uint number)
{
    if (TEXELS == 0u) {
        return instances[number];
    }
    return instance_of(uintBitsToFloat(instance_words(number, 0)), uintBitsToFloat(instance_words(number, 1)),
                       uintBitsToFloat(instance_words(number, 2)), uintBitsToFloat(instance_words(number, 3)),
                       instance_words(number, 4));
}
#endif

WalkNode node_at(uint number)
{
    if (TEXELS == 0u) {
        return walk_nodes[number];
    }
    uvec4 words = texelFetch(node_texels, int(number));
    return WalkNode(words.xyz, words.w);
}

uvec4 object_words(uint number, int at)
{
    return texelFetch(object_texels, int(OBJECT_STRIDE_WORDS / 4u * number) + at);
}

vec4 object_floats(uint number, int at)
{
    return uintBitsToFloat(object_words(number, at));
}

Shape shape_at(uint number)
{
    if (TEXELS == 0u) {
        return objects[number].object.shape;
    }
    return shape_of(object_floats(number, 0), object_floats(number, 1), object_floats(number, 2),
                    object_words(number, 3), object_words(number, 4), object_words(number, 5), object_words(number, 6));
}

Appearance appearance_at(uint number)
{
    if (TEXELS == 0u) {
        return objects[number].object.appearance;
    }
    return appearance_of(object_words(number, 7), object_floats(number, 8), object_floats(number, 9),
                         object_words(number, 10));
}

// Set by load_frame() first and then by load(). The order matters: software drivers read uniform buffers once for all
// lanes at the very start of a shader, but lane by lane wherever lanes may be inactive. Unused copies cost nothing.
// Fragments receive their most frequent inputs as flat varyings.
Frame frame;
vec3 depth_window; // first_depth, depth_range and far_depth
Light first_light;
Light second_light;
Shape shape; // of the current object: the instance's, or one that may cast a shadow on it
Appearance appearance;

// True if the box cuts nothing of the object, and rays from the eye begin outside of it.
bool is_outside()
{
    return OUTSIDE == 1u || (OUTSIDE == 0u && (shape.flags & OUTSIDE_BIT) != 0u);
}

// Loads what all invocations share: the frame, and object `only` if the draw or dispatch has one object.
void load_frame(uint only)
{
    frame = frame_block.frame;
    depth_window = vec3(frame_block.first_depth, frame_block.depth_range, frame_block.far_depth);
    first_light = frame_block.lights[0];
    second_light = frame_block.lights[1];
    if (ONE_OBJECT != 0u) {
        shape = own_object.shape;
        appearance = own_object.appearance;
        // Loop lengths come from the storage buffer: lavapipe 22 treats uniforms that loops depend on as constants, and
        // crashes.
        shape.most_steps = objects[only].object.shape.most_steps;
        shape.replicas = objects[only].object.shape.replicas;
        shape.flags = objects[only].object.shape.flags;
    }
}

// Sets the tables of the copy's level. They count from the buffer of tables that is read.
void load_level(Instance i)
{
    shape.listed = i.listed - (OWN_TABLES ? shape.listed_window : 0u);
    shape.table = i.table - (OWN_TREE ? shape.table_window : 0u);
}

// Loads what a search reads of an instance's object.
void load_shape(Instance i)
{
    if (ONE_OBJECT == 0u) {
        shape = shape_at(i.object);
    }
    load_level(i);
}

// Loads an instance's object.
void load(Instance i)
{
    load_shape(i);
    if (ONE_OBJECT == 0u) {
        appearance = appearance_at(i.object);
    }
}

#endif
