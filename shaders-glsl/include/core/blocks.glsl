// Blocks that the CPU writes for each frame, object and instance. src/shader/blocks.rs has the same layout; a
// test compares the offsets.
#ifndef BLOCKS_GLSL
#define BLOCKS_GLSL
#include "core/variant.glsl"

struct Light {
    vec4 towards; // unit, from the surface to the light; w: 1 - cos of its angular radius
    vec4 color;   // linear RGB
};

struct Frame {
    vec4 clip_x;  // clip x of a world vector; w: 1 where rays are parallel
    vec4 clip_y;  // clip y; w: depth of the near plane
    vec4 dir_00;  // ray through the centre of pixel (0, 0), forward component 1; w: pixel width at unit depth
    vec4 dir_x;   // change of the ray per column; w: depth in clip space = w + dir_y.w / t
    vec4 dir_y;   // change of the ray per row
    vec4 forward; // unit; w: sense of depth, 1 where depth grows away from the eye, else -1
    vec4 ambient; // linear RGB; w: depth of the near plane in clip space
    uvec4 size;   // width, height, number of lights, first record of the last frame's placements
    vec4 pixels;  // clip x = x * (x of a pixel's corner) + y; clip y = z * (y of a pixel's corner) + w
    vec4 caster_eye;       // the eye, from the origin of the hierarchy of shadow.glsl; w: number of shape maps (bits)
    vec4 caster_middle;    // root of the hierarchy: middle of its box; w: number of all nodes (bits)
    vec4 caster_half_size; // root; w: index of the only copy, or INNER_NODE (bits)
    vec4 view; // unused; depth range: first, last - first; far end
    Light lights[MAX_LIGHTS];
};

layout(set = 0, binding = 0, std140) uniform FrameBlock {
    Frame frame_block;
};

// Current frame. Software drivers read uniform buffers lane by lane in fragment shaders and wherever lanes may be
// inactive; only at the very start of a compute shader do they read once for all lanes. Entry files therefore first
// copy the members one by one. Unused copies cost nothing. Fragments receive their most frequent inputs as flat
// varyings.
Frame frame; // its lights are not copied, but for the first two
Light first_light;
Light second_light;

// An instance relative to the eye. The CPU computes it in double precision for each view, so that no rounding error
// grows with the distance from the origin or the eye.
struct Instance {
    vec4 position_sx; // middle of the box's lower face from the eye, world axes; scale along x
    vec4 rotation;    // unit quaternion, x y z w
    vec4 scale_depth; // scale along y and z; depth of the box's middle; clip x of the box's middle
    vec4 origin;      // ray origin of pixel (0, 0) (pixel_ray.glsl), object space; w: clip y of the box's middle
    uvec4 object;     // index of its object; unused; first vectors of its listed patches and of its table
};

// An object: the data that its instances share.
struct Object {
    vec4 map;        // columns, rows, texel h in object units, factor from stored to object units
    vec4 bounds;     // R; clip radius about the axis; clip z, low and high
    vec4 offset;     // e, b, c; upper limit on search steps
    vec4 axis;       // x, y from the box's middle, object units; 1 / outline length; arc length at z = 0 over it
    vec4 albedo;     // linear RGB
    vec4 specular;   // strength, shininess; height of the box and of its part below z = 0, profile units
    vec4 texturing;  // repetitions along xi and eta; bump depth a; 2 R of the profile's box in its units
    uvec4 cells;     // replicas along x, y, z; bits: reflected along x, y, z, then OUTSIDE_BIT
    uvec4 instances; // first, count, index of the shape map among those of shadows, first vector of all tables
    uvec4 patches;   // table start, the copy's; three words: quadric search: 0, 0, unit of r^2 (bits); other searches:
                     // three words of their own
    uvec4 parts;     // first frustum; roughness and metalness (16 bits each); first vector of listed patches, the copy's,
                     // and of those of all levels
    uvec4 levels;    // table starts of the levels of copies after the finest
};

// An object padded to the largest alignment of uniform buffer offsets on any device.
struct PaddedObject {
    Object object;
    uvec4 padding[4];
};

layout(set = 0, binding = 1, std430) readonly buffer ObjectBlock {
    PaddedObject objects[];
};

// The object of a draw or dispatch that has only one.
layout(set = 0, binding = 6, std140) uniform OwnObject {
    Object own_object;
};

#ifndef INSTANCE_ACCESS
#define INSTANCE_ACCESS readonly
#endif
layout(set = 0, binding = 2, std430) INSTANCE_ACCESS buffer InstanceBlock {
    Instance instances[];
};

// Current object: the instance's, or one that may cast a shadow on it.
Object object;
bool traces_caster = false;

// Returns true while the traced object is a possible shadow caster.
bool casts()
{
    return SHADOW != SHADOW_OFF && traces_caster;
}

// True if the box cuts nothing of the object, and rays from the eye begin outside of it.
bool is_outside()
{
    return OUTSIDE == 1u || (OUTSIDE == 0u && (object.cells.w & OUTSIDE_BIT) != 0u);
}

void take_frame()
{
    frame.clip_x = frame_block.clip_x;
    frame.clip_y = frame_block.clip_y;
    frame.dir_00 = frame_block.dir_00;
    frame.dir_x = frame_block.dir_x;
    frame.dir_y = frame_block.dir_y;
    frame.forward = frame_block.forward;
    frame.ambient = frame_block.ambient;
    frame.size = frame_block.size;
    frame.pixels = frame_block.pixels;
    first_light.towards = frame_block.lights[0].towards;
    first_light.color = frame_block.lights[0].color;
    second_light.towards = frame_block.lights[1].towards;
    second_light.color = frame_block.lights[1].color;
}

#define TAKE_SHAPE(from) \
    object.map = from.map; \
    object.bounds = from.bounds; \
    object.offset = from.offset; \
    object.axis = from.axis; \
    object.cells = from.cells; \
    object.patches = from.patches

#define TAKE_OBJECT(from) \
    TAKE_SHAPE(from); \
    object.albedo = from.albedo; \
    object.specular = from.specular; \
    object.texturing = from.texturing; \
    object.instances = from.instances; \
    object.parts = from.parts

// Loads the object of a draw or dispatch that has only one.
void take_only_object(uint number)
{
    if (ONE_OBJECT != 0u) {
        TAKE_OBJECT(own_object);
        // Loop lengths come from the storage buffer: lavapipe 22 treats uniforms that loops depend on as constants, and
        // crashes.
        object.offset.w = objects[number].object.offset.w;
        object.cells = objects[number].object.cells;
    }
}

// Sets the places of the tables that a copy's level has. They count from the buffer of tables that is read.
void take_level(Instance i)
{
    object.parts.z = i.object.z - (OWN_TABLES ? object.parts.w : 0u);
    object.patches.x = i.object.w - (OWN_TABLES ? object.instances.w : 0u);
}

// Loads the rest: one of several objects, and a copy's level.
void take_one_of_objects(Instance i)
{
    if (ONE_OBJECT == 0u) {
        TAKE_OBJECT(objects[i.object.x].object);
    }
    take_level(i);
}

void take_object(Instance i)
{
    take_only_object(i.object.x);
    take_one_of_objects(i);
}

// Loads the members of an object that a search reads and that another copy of the draw may not share.
void take_shape(Instance i)
{
    if (ONE_OBJECT == 0u) {
        TAKE_SHAPE(objects[i.object.x].object);
    }
    take_level(i);
}

#endif
