// What the CPU tells the GPU: once a frame, once a batch, once an instance. Mirrored by src/gpu/blocks.rs;
// a test compares the offsets.
#ifndef BLOCKS_GLSL
#define BLOCKS_GLSL
#include "variant.glsl"

struct Light {
    vec4 towards; // unit, from the surface to the light
    vec4 color;   // linear RGB
};

struct Frame {
    mat4 clip_from_world;
    vec4 eye;     // world; w: depth of the near plane
    vec4 dir_00;  // ray through the centre of pixel (0, 0), forward component 1; w: pixel's size at unit depth
    vec4 dir_x;   // its change from column to column; w: depth = w + dir_y.w / t
    vec4 dir_y;   // its change from row to row
    vec4 forward; // unit
    vec4 ambient; // linear RGB
    uvec4 size;   // width, height, number of lights, bins across
    Light lights[MAX_LIGHTS];
};

layout(set = 0, binding = 0, std140) uniform FrameBlock {
    Frame frame_block;
};

// Entry files copy the blocks before anything else: software drivers read a uniform buffer lane by lane in fragments and wherever lanes
// may have left, and only at a compute shader's very beginning all at once. What fragments need most comes to them in flat varyings.
Frame frame;

struct Instance {
    vec4 position_sx; // of the middle of the box's lower face; scale along x
    vec4 rotation;    // unit quaternion, x y z w
    vec4 scale_yz;    // scale along y and z
};

// A batch: instances that share shape, look and variant.
struct Solid {
    vec4 map;        // columns, rows, texel h in object units, factor from stored to object units
    vec4 bounds;     // R; clip radius about the axis; clip z, low and high
    vec4 offset;     // e, b, c; largest w
    vec4 axis;       // x, y in object units from the middle of the box; 1 / length of the outline; arc length at z = 0 over that
    vec4 albedo;     // linear RGB
    vec4 specular;   // strength, shininess
    vec4 texturing;  // repetitions along xi and eta; bump depth a
    uvec4 cells;     // replicas along x, y, z; bits: reflected along x, y, z
    uvec4 instances; // first, number, index of the shape map among those of shadows
    uvec4 pieces;    // of the quadric search's tables (piece_tables.glsl): where they begin, first record, first range, bits of the unit of r^2;
                     // of the cone search's: where they begin, rows, bits of the largest radius
    uvec4 hull;      // first band; first vector of the nodes that beams are asked against
    Instance single; // the batch's instance, where it has but one, or one of a few that beams are sent to
};

layout(set = 0, binding = 1, std140) uniform BatchBlock {
    Solid batch_solid;
};

layout(set = 0, binding = 3, std140) uniform ShadowBlock {
    uvec4 shadow_batches; // their number
    Solid shadow_solids[MAX_SHADOW_BATCHES];
};

// What is traced at present: the batch's solid, or one that may throw a shadow on it.
Solid solid;
int shadow_map = -1; // of that solid, among `shadow_maps`; negative: the batch's own

layout(set = 0, binding = 2, std430) readonly buffer InstanceBlock {
    Instance instances[];
};

// Of the batch that is drawn; software drivers read uniform buffers much faster than storage buffers.
Instance batch_instance(uint index)
{
    if (SINGLE != 0u) {
        return solid.single;
    }
    return instances[index];
}

#endif
