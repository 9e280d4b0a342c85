// Structures in buffers that the CPU and the shaders share. build.rs makes the same structures for Rust from this file,
// and refuses a member whose place would differ. A vec3 is always followed by a member of one word.
#ifndef STRUCTURES_GLSL
#define STRUCTURES_GLSL
#include "core/variant.glsl"

struct Light {
    vec3 towards; // unit, from the surface to the light
    float cap;    // 1 - cos of its angular radius
    vec3 color;   // linear RGB
    float unused;
};

// The view of a frame.
struct Frame {
    vec3 clip_x; // change of clip x for a step in the world
    float parallel; // 1 if rays are parallel, else 0
    vec3 clip_y; // change of clip y
    float near; // depth of the near plane
    vec3 dir_00; // ray through the centre of pixel (0, 0), forward component 1
    float pixel_size; // width of a pixel at unit depth
    vec3 dir_x; // change of the ray per column
    float depth_constant; // depth in clip space = depth_constant + depth_factor / t, or * t if rays are parallel
    vec3 dir_y; // change of the ray per row
    float depth_factor;
    vec3 forward; // unit
    float depth_sense; // 1 if depth grows away from the eye, else -1
    vec3 ambient; // linear RGB
    float near_depth; // depth of the near plane in clip space
    uvec2 size; // pixels
    uint light_count;
    uint last_copies; // index of the first LastCopy among instances
    vec2 clip_scale; // clip position = clip_scale * position in the picture + clip_shift
    vec2 clip_shift;
};

// The root of the hierarchy of copies that may cast shadows, and the eye.
struct CasterRoot {
    vec3 eye; // from the lower corner of the grid of hierarchies
    uint map_count; // number of shape maps
    vec3 middle; // of the root's box
    uint root; // index of the node before it
    vec3 half_size;
    uint only_copy; // index of the only copy, or INNER_NODE
};

// The eye and the ray of pixel (0, 0) in double precision, for copies that the device places (place.comp), and
// the eye in the grid of the hierarchies that rays walk (stage/tile_walk.glsl).
struct PlacedEye {
    vec3 high; // the eye is high + middle + low, world axes
    float unused_0;
    vec3 middle;
    float unused_1;
    vec3 low;
    float unused_2;
    vec3 dir_high; // 12 bits of dir_00 in each member
    float unused_3;
    vec3 dir_middle; // the next 12 bits
    float unused_4;
    vec3 dir_low; // the rest
    float unused_5;
    vec3 grid_unit; // length of a step of the grid along each axis
    float unused_6;
    vec3 grid_low; // the eye in such steps, and a margin
    float unused_7;
    vec3 grid_high; // less the margin
    float unused_8;
};

// All data of a frame.
struct FrameData {
    Frame frame;
    CasterRoot casters;
    PlacedEye eye;
    uvec4 picture; // left and upper edge, width, height, pixels
    float first_depth; // the depth buffer's value of depth 0 in clip space
    float depth_range; // its value of depth 1, minus first_depth
    float far_depth; // depth in clip space of the far plane
    float ray_width; // width of the part of a pixel that a ray stands for: 1, or less if a pixel has several rays
    float ray_start; // depth at which rays from the eye begin: that of a host's near plane, 0 in a scene's view
    float unused;
    vec2 lag_depth; // change of depth_constant and depth_factor for a lag of 1
    Light lights[MAX_LIGHTS];
    vec4 sky_up; // linear RGB of the environment straight up
    vec4 sky_down;
};

// A copy of an object, relative to the eye. The CPU computes it in double precision for each view, so that no rounding
// error grows with the distance from the world's origin or from the eye. Copies whose `table` is PLACED have no view:
// their position in the world is the sum of `position`, `origin` and (depth, clip_x, clip_y), and place.comp makes the
// other members.
struct Instance {
    vec3 position; // middle of the box's lower face, from the eye, world axes
    float depth; // depth of the box's middle
    vec3 scale;
    float clip_x; // clip x of the box's middle
    vec4 rotation; // unit quaternion, x y z w
    vec3 origin; // ray origin of pixel (0, 0) (pixel_ray.glsl), object space
    float clip_y; // clip y of the box's middle
    uint object; // index of its object
    uint listed; // first vector of its table of listed patches
    uint table; // first vector of its table
    float lag; // part of a hit's depth by which the hit is farther in comparisons (src/plan/precedence.rs)
};

// Where a copy was in the last frame. It has the size of an Instance: both are in one buffer.
struct LastCopy {
    vec4 row_x; // rows of the map from object space to (x w, y w, w), x and y in pixels
    vec4 row_y;
    vec4 row_w;
    vec2 jitter; // half a pixel minus the view's jitter
    float farther; // by which the surface was farther out along its normal, object units
    float unused;
    uvec4 unused_too;
};

// The members of an object that a search reads. Lengths are in object units.
struct Shape {
    vec2 map_size; // columns, rows
    float texel; // size of a texel of the map
    float map_scale; // factor from the map's stored values
    float half_side; // half of the box's side, R
    float clip_radius; // nothing is solid outside of this cylinder about the axis
    float clip_low; // and of this range of z
    float clip_high;
    float extend; // e
    float bevel; // b
    float chamfer; // c
    float most_steps; // upper limit on steps
    vec2 axis; // from the box's middle
    uint shadow_map; // index of the shape map among those of shadows
    uint first_frustum; // first vector of the frusta
    uvec3 replicas; // along x, y, z
    uint flags; // bits: replicas are reflected along x, y, z, then OUTSIDE_BIT
    uint table; // first vector of the copy's table; set by load_level()
    uint table_fact_0; // words about the table, by search; the quadric search has no first two
    uint table_fact_1;
    uint table_fact_2; // quadric search: unit of r^2 (bits of a float)
    uint listed; // first vector of the copy's table of listed patches; set by load_level()
    uint listed_window; // first vector of such tables of all levels
    uint table_window; // first vector of the tables of all levels
    uint unused;
};

// The members of an object that only shading reads.
struct Appearance {
    vec3 color; // linear RGB
    uint material; // roughness and metalness, 16 bits each
    float specular; // strength
    float shininess;
    float box_height; // of the box that is drawn, profile units
    float box_low; // height of its part below z = 0, profile units
    vec2 texture_repeat; // along xi and eta
    float bump; // depth a
    float profile_width; // 2 R of the profile's box in its units
    float arc_rate; // 1 / outline length
    uint first_instance;
    vec2 texture_offset; // added to positions in a map
};

struct Object {
    Shape shape;
    Appearance appearance;
};

// The tables of an object whose copies have levels of their own, for copies that the device places.
struct LevelTables {
    vec4 limits; // level n + 1 is allowed from this multiple of the copy's largest scale on (src/plan/levels.rs)
    uvec4 tables; // first vector of the tables of levels 0 to 3
    uint last_table; // of level 4
    uint listed; // first vector of the patches for lists, of all levels
    uint unused_0;
    uint unused_1;
};

// A node of a hierarchy. `index` of a node without children is its copy, or INNER_NODE. The node before the root has
// the index of the first node without children; the children of node `k` are 2 k and 2 k + 1.
struct WalkNode {
    uvec3 bounds; // along each axis: least step of the grid | largest << 16
    uint index;
};

// A tile whose patches are listed, in a bin.
struct BinTile {
    uint square; // its corner: x | y << QUAD_BITS, pixels
    uint instance; // index of its only copy
    uvec2 found; // two runs of patches (first | number << 9 | first << 15 | number << 24), 1 << 31 if rays begin at a
                 // height; that height, else 0.5 (bits of floats)
};

// Push constants of a dispatch.
struct Pushed {
    uint first; // index of the first square, block of tiles, open pixel or instance
    uint placed; // number of instances that are placed
    uint corner; // upper left pixel of the rectangle of squares: x | y << QUAD_BITS
    uint size; // squares across | down << 16
    uint root; // index of the hierarchy
    uint heads; // index of the first head of the bins
    uint tiles; // index of the first tile of the bins, or of the bin that is read; of the first vector of walks
    uint room; // lists: number of tiles that a bin holds
    uint walks; // 0 if all tiles of the rectangle walk, or one of WALKS_*
    uint object; // index of the only object
    uint instance; // index of its only copy
};

#endif
