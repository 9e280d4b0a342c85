// Blocks of the frame, of objects and of copies, and the values of the current ones.
#ifndef BLOCKS_GLSL
#define BLOCKS_GLSL
#include "core/structures.glsl"

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

layout(set = 0, binding = 2, std430) readonly buffer InstanceBlock {
    Instance instances[];
};

// Nodes of all hierarchies of copies (src/plan/walk.rs).
layout(set = 0, binding = 3, std430) readonly buffer WalkBlock {
    WalkNode walk_nodes[];
};

layout(set = 0, binding = 2, std430) readonly buffer LastCopyBlock {
    LastCopy last_copies[];
};

// Set by load_frame() first and then by load(). The order matters: software drivers read uniform buffers once for all
// lanes at the very start of a shader, but lane by lane wherever lanes may be inactive. Unused copies cost nothing.
// Fragments receive their most frequent inputs as flat varyings.
Frame frame;
vec3 depth_window; // first_depth, depth_range and far_depth
Light first_light;
Light second_light;
Shape shape; // of the current object: the instance's, or one that may cast a shadow on it
Appearance appearance;
bool traces_caster = false;
bool start_is_known = false;
bool starts_within_caster; // if it is known

// Returns true while the traced object is a possible shadow caster.
bool casts()
{
    return SHADOW != SHADOW_OFF && traces_caster;
}

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
    shape.table = i.table - (OWN_TABLES ? shape.table_window : 0u);
}

// Loads what a search reads of an instance's object.
void load_shape(Instance i)
{
    if (ONE_OBJECT == 0u) {
        shape = objects[i.object].object.shape;
    }
    load_level(i);
}

// Loads an instance's object.
void load(Instance i)
{
    load_shape(i);
    if (ONE_OBJECT == 0u) {
        appearance = objects[i.object].object.appearance;
    }
}

#endif
