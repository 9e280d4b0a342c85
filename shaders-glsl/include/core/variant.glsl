// Compile-time options of a module, and the constants shared with the CPU. build.rs defines the macros for each entry
// of src/shader/catalogue.rs, and generates the same constants for Rust from this file.
#ifndef VARIANT_GLSL
#define VARIANT_GLSL

#define SEARCH_NONE 0    // vertices, lists of patches
#define SEARCH_EXTERNAL 1 // from another crate: search/external.glsl
#define SEARCH_LIVE 2    // safe steps to within a texel and a final secant, on the map only
#define SEARCH_QUADRIC 3 // exact patches of quadrics, rebuilt when parameters change

#define READS_MAP (SEARCH == SEARCH_LIVE || SEARCH == SEARCH_EXTERNAL && !SEARCH_TABLE)
#define READS_TABLES (SEARCH == SEARCH_QUADRIC || SEARCH == SEARCH_EXTERNAL && SEARCH_TABLE)
#define TAKES_STEPS (READS_MAP || SEARCH_BOUNDED) // limited by an upper limit on steps

#define OUTPUT_COLOR 0
#define OUTPUT_PLANES 1 // every plane of a frame
#define OUTPUT_DEPTH 2  // no shading at all
#define OUTPUT_LIST 3   // planes by a host's list

// Other macros are defined or not:
// - STORED_TABLES: tables are read from the storage buffer even if there is one object, and by no view of it;
// - STORED_TREE: those of the tree alone;
// - SINGLE: no replicas, in entries that do not draw them;
// - UNSHADOWED: no shadows, in entries that do not draw them;
// - HOST_SHADING: a function of the host shades; lights and shadows of the library are left out.
#ifndef SEARCH
#define SEARCH SEARCH_NONE
#endif
#ifndef SEARCH_TABLE
#define SEARCH_TABLE 0 // 1: the external search reads a table of its own; else the map
#endif
#ifndef SEARCH_BOUNDED
#define SEARCH_BOUNDED 0 // 1: the steps of a search on a table are limited too
#endif
#ifndef OUTPUT
#define OUTPUT OUTPUT_COLOR
#endif

// All else is specialisation constants. src/shader/frozen.rs makes them plain before a driver reads a module.
#ifdef SINGLE
const uint REPLICAS = 0u;
#else
layout(constant_id = 0) const uint REPLICAS = 0u; // 1: the box holds several replicas
#endif
#ifdef UNSHADOWED
const uint SHADOW = 0u;
#else
layout(constant_id = 1) const uint SHADOW = 0u; // one of SHADOW_*
#endif
layout(constant_id = 7) const uint ENVIRONMENT = 0u; // 1: surfaces reflect the sky
layout(constant_id = 2) const uint COLOR_MAP = 0u; // 1: colours come from a map
layout(constant_id = 3) const uint BUMP = 0u; // BUMP_*
layout(constant_id = 4) const uint PROJECTION = 2u; // one of PROJECTION_*
#if OUTPUT == OUTPUT_DEPTH
layout(constant_id = 23) const uint ORTHO = 0u; // 1: rays are parallel
#else
const uint ORTHO = 0u;
#endif
#if READS_MAP
layout(constant_id = 24) const uint RGBA8 = 0u; // 1: the papers' map of unsigned distance; else one channel, signed
#else
const uint RGBA8 = 0u;
#endif
#if SEARCH == SEARCH_EXTERNAL
layout(constant_id = 5) const uint SEARCH_FORM = 0u; // distinguishes searches that share their modules
layout(constant_id = 10) const uint KNOWN_STEPS = 0u; // upper limit on steps; 0: the limit in the object's block
#endif
layout(constant_id = 6) const uint DEPTHS = 1u; // compute; 0: each pixel is drawn once: no depth is compared or kept
layout(constant_id = 8) const uint LIGHTS = 3u; // upper limit on lights: 1, 2, or 3 for any number
layout(constant_id = 11) const uint CUT_CELLS = 0u; // 1: a side of the box may cut the cells
layout(constant_id = 12) const uint OUTSIDE = 0u; // 1: the blocks of all objects of the draw have OUTSIDE_BIT; 2: none has it
layout(constant_id = 14) const uint ONE_OBJECT = 0u; // 1: the draw has one object; uniform buffers hold its block and its tables; 2: and one copy of it
layout(constant_id = 13) const uint OWN_VECTORS = 1024u; // capacity of the uniform buffer of tables, vectors
layout(constant_id = 15) const uint LARGE_POINTS = 1u; // 1: the device draws points of 1 to 8 pixels a side
layout(constant_id = 20) const uint TEXELS = 0u; // 1: views of buffers are read where invocations read different places
layout(constant_id = 18) const uint FETCHED_CELLS = 0u; // 1: fragments fetch the patches of their cell; 0: vertices pass them
layout(constant_id = 19) const uint SINGLE_CELLS = 0u; // 1: each cell of the draw has one patch
layout(constant_id = 21) const uint SLOPE_BIAS = 0u; // depth-only passes: bias for a slope of 1 (bits of a float)
layout(constant_id = 22) const uint SLOPE_BIAS_LIMIT = 0u; // its upper limit, units of the depth buffer (bits of a float)
layout(constant_id = 16) const uint BEVELED = 0u; // 1: there may be a bevel
layout(constant_id = 9) const uint LIST_LENGTH = 8u; // patches per pixel of a listed tile

// True if tables are read from the uniform buffer of one object's.
#ifdef STORED_TABLES
#define OWN_TABLES false
#else
#define OWN_TABLES (ONE_OBJECT != 0u)
#endif
// The same of the tables of the tree.
#ifdef STORED_TREE
#define OWN_TREE false
#else
#define OWN_TREE OWN_TABLES
#endif

const uint PROJECTION_PLANAR = 1u;
const uint PROJECTION_CYLINDRICAL = 2u;
const uint PROJECTION_SPHERICAL = 3u;
const uint PROJECTION_ARC = 4u;

const uint BUMP_OFF = 0u;
const uint BUMP_SURFACE_GRADIENT = 1u;
const uint BUMP_PAPERS = 2u;
const uint BUMP_HEIGHTS = 4u; // in addition to one of both: the image holds heights, not slopes

const uint SHADOW_OFF = 0u;
const uint SHADOW_HARD = 1u;
const uint SHADOW_SOFT = 2u;

const uint EXHAUSTED_BIT = 2147483648u; // bit in a pixel's word of look-ups: one of its rays ran out of steps

const uint OUTSIDE_BIT = 8u; // bit in an object's block: its box cuts nothing, and rays from the eye begin outside of the solid

const uint MAX_LIGHTS = 8u;
const uint INSTANCE_WORDS = 20u; // words of an Instance
const uint OBJECT_WORDS = 44u; // words of an Object
const uint OBJECT_STRIDE_WORDS = 64u; // words from one object to the next: the largest alignment of uniform buffer offsets
const uint PATCH_VECTORS = 1024u; // minimum of OWN_VECTORS: uniform buffers of every device hold this many
const uint MOST_OWN_VECTORS = 4096u;
const uint PATCH_ROWS = 256u; // rows of a solid's tables, a power of 4
const uint PATCH_NODES = 340u; // nodes of the tree over the rows: 256 + 64 + 16 + 4
const uint RING_CORNERS = 12u; // corners of a frustum's rings
const uint PATCHES_PER_CELL = 8u; // upper limit on patches of a cell
const uint FRUSTUM_VECTORS = 17u; // vectors of a frustum: its rings, then the cell's quadrics and guards
const uint LISTED_PATCHES = 340u; // upper limit on patches of a solid with lists, three vectors each
const uint WALK_BIN = 4u; // head of the tiles that walk; before it, one for the bin of each length of a list of patches
const uint TILE_BINS = 5u; // number of heads
const uint SHORT_LIST = 8u; // first of the list lengths
const uint MIDDLE_LIST = 16u;
const uint LONG_LIST = 32u;
const uint LONGEST_LIST = 48u;
const uint MAX_SHADOW_MAPS = 8u; // upper limit on shape maps of a scene with shadows, for searches on maps
const uint INNER_NODE = 4294967295u; // in place of a copy, in nodes of hierarchies that have none
const uint PLACED = 4294967295u; // in place of a copy's table: the device places it
const uint WALKS_LISTED = 1u; // a dispatch of walks has the tiles of a list, not all of a rectangle
const uint WALKS_OPEN = 2u; // each of its invocations reads its pixel
const uint TILE_WALK_VECTORS = 2u; // vectors of a tile's walk
const uint LEVEL_WORDS = 12u; // words of LevelTables
const uint GROUP_PIXELS = 8u; // side of a tile, and of compute workgroups that cull no patches
const uint CULLED_PIXELS = 16u; // side of a compute workgroup that culls patches
const uint QUAD_BITS = 15u; // bits of each coordinate of a pixel
const uint NO_PIXEL = 4294967295u; // position outside of any picture, which fills up the last group of open pixels
const uint MOST_GROUPS = 65535u; // work groups of a dispatch along one axis, on every device
const uint BOX_INDICES = 36u; // indices of a shape box

#endif
