// What the CPU gives the GPU for each frame, object and instance. src/gpu/resources/blocks.rs has the
// same; a test compares the offsets.
#ifndef BLOCKS_GLSL
#define BLOCKS_GLSL
#include "core/variant.glsl"

struct Light {
    vec4 towards; // unit, from the surface to the light; w: 1 - cos of its angular radius
    vec4 color;   // linear RGB
};

struct Frame {
    vec4 clip_x;  // clip x of a way in the world; w: 1 where rays are parallel
    vec4 clip_y;  // clip y; w: depth of the near plane
    vec4 dir_00;  // ray through the centre of pixel (0, 0), forward component 1; w: pixel's size at unit depth
    vec4 dir_x;   // its change from column to column; w: depth = w + dir_y.w / t
    vec4 dir_y;   // its change from row to row
    vec4 forward; // unit; w: sense of depth, 1 where it grows away from the eye, -1 where it falls
    vec4 ambient; // linear RGB; w: depth value of the near plane
    uvec4 size;   // width, height, number of lights, unused
    vec4 pixels;  // clip x = x of a pixel's corner * x + y; clip y = y of it * z + w
    Light lights[MAX_LIGHTS];
};

layout(set = 0, binding = 0, std140) uniform FrameBlock {
    Frame frame_block;
};

// What is traced and seen at present. Software drivers read a uniform buffer lane by lane in fragments and wherever
// lanes may have left, and only at a compute shader's very beginning all at once. So entry files take over its members,
// one by one, before anything else; those that nothing reads cost nothing. What fragments need most comes to them in
// flat varyings.
Frame frame; // without the lights

// As the eye sees it: found in double precision for each view, so that no rounding grows with the distance from the
// origin or the eye.
struct Instance {
    vec4 position_sx; // of the middle of the box's lower face, from the eye, world axes; scale along x
    vec4 rotation;    // unit quaternion, x y z w
    vec4 scale_depth; // scale along y and z; depth of the box's middle; its clip x
    vec4 origin;      // of the ray of pixel (0, 0) (pixel_ray.glsl), object space, from the axis at z = 0; w: clip y of the box's middle
    uvec4 solid;      // x: number of its solid; y: bits of the distance from its position that the box reaches
};

// An object: what its instances share.
struct Solid {
    vec4 map;        // columns, rows, texel h in object units, factor from stored to object units
    vec4 bounds;     // R; clip radius about the axis; clip z, low and high
    vec4 offset;     // e, b, c; bound of the search's steps
    vec4 axis;       // x, y in object units from the middle of the box; 1 / length of the outline; arc length at z = 0 over that
    vec4 albedo;     // linear RGB
    vec4 specular;   // strength, shininess; height of the box, and of its part below z = 0, in units of the profile's box
    vec4 texturing;  // repetitions along xi and eta; bump depth a; 2 R of the profile's box in its units
    uvec4 cells;     // replicas along x, y, z; bits: reflected along x, y, z
    uvec4 instances; // first, number, index of the shape map among those of shadows
    uvec4 patches;    // of the quadric search's tables (patch_tables.glsl): where they begin, first record, first range, bits of the unit of r^2;
                     // of another search's: where they begin, three words of its own
    uvec4 hull;      // first frustum; unused; first vector of the listed patches, of the rows of sides
};

// As far apart as places in a uniform buffer are on any device.
struct SolidPlace {
    Solid solid;
    uvec4 padding[5];
};

layout(set = 0, binding = 1, std430) readonly buffer SolidBlock {
    SolidPlace solids[];
};

// The only one that a draw or dispatch has.
layout(set = 0, binding = 6, std140) uniform OwnSolid {
    Solid own_solid;
};

layout(set = 0, binding = 2, std430) readonly buffer InstanceBlock {
    Instance instances[];
};

// The instance's, or one that may throw a shadow on it.
Solid solid;

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
}

// The same way from either buffer.
#define TAKE_SOLID(from) \
    solid.map = from.map; \
    solid.bounds = from.bounds; \
    solid.offset = from.offset; \
    solid.axis = from.axis; \
    solid.albedo = from.albedo; \
    solid.specular = from.specular; \
    solid.texturing = from.texturing; \
    solid.cells = from.cells; \
    solid.instances = from.instances; \
    solid.patches = from.patches; \
    solid.hull = from.hull

void take_solid(uint number)
{
    if (ONE_SOLID != 0u) {
        TAKE_SOLID(own_solid);
        // Lengths of loops: lavapipe 22 takes uniforms that loops depend on for constants, and crashes over it.
        solid.offset.w = solids[number].solid.offset.w;
        solid.cells = solids[number].solid.cells;
    } else {
        TAKE_SOLID(solids[number].solid);
    }
}

#endif
