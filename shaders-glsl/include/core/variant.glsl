// What a module is compiled for, and the numbers that the CPU must know. build.rs defines the macros for each entry of
// src/shader/list.rs, and generates the same numbers for Rust from this file.
#ifndef VARIANT_GLSL
#define VARIANT_GLSL

#define SEARCH_NONE 0    // vertices, lists of tiles
#define SEARCH_CIRCLE 1  // the papers' loop
#define SEARCH_LIVE 2    // steps that are safe to a texel and a last secant, on the map alone
#define SEARCH_QUADRIC 3 // exact patches of quadrics, rebuilt when parameters change
#define SEARCH_LINEAR 4  // equal steps, then nothing, halvings or secants
#define SEARCH_CONE 5    // empty cones on each row, for solids that are single-valued in z
#define SEARCH_RELAXED 6 // the same, relaxed, and halvings

#define READS_MAP (SEARCH == SEARCH_CIRCLE || SEARCH == SEARCH_LIVE || SEARCH == SEARCH_LINEAR)
#define READS_TABLES (SEARCH == SEARCH_QUADRIC || SEARCH == SEARCH_CONE || SEARCH == SEARCH_RELAXED)
#define TAKES_STEPS (READS_MAP || SEARCH == SEARCH_RELAXED) // so many of them at most

#define OUTPUT_COLOR 0
#define OUTPUT_PLANES 1 // every plane of a frame
#define OUTPUT_DEPTH 2  // no shading at all

#define DISPATCH_RECTANGLE 0 // compute: one instance, every pixel of its rectangle
#define DISPATCH_BINS 1      // several instances, listed for each square of the screen
#define DISPATCH_BEAMS 2     // one instance; tiles, and where their rays begin and end, come from beam.comp
#define DISPATCH_LISTS 3     // one instance; tiles, and the patches that their rays may meet, come from list.comp

// What build.rs leaves out is 0.
#ifndef SEARCH
#define SEARCH SEARCH_NONE
#endif
#ifndef RGBA8
#define RGBA8 0 // 1: the papers' texture of unsigned distance; else one channel of signed distance
#endif
#ifndef BEVELED
#define BEVELED 0 // 1: there may be a bevel
#endif
#ifndef OWN_TABLES
#define OWN_TABLES 0 // 1: the batch's tables fit into a uniform buffer
#endif
#ifndef TEXTURED
#define TEXTURED 0 // 1: colours or bumps may come from maps
#endif
#ifndef REPEATED
#define REPEATED 0 // 1: the box may hold several replicas
#endif
#ifndef SHADOWED
#define SHADOWED 0 // 1: solids may throw shadows
#endif
#ifndef OUTPUT
#define OUTPUT OUTPUT_COLOR
#endif
#ifndef DISPATCH
#define DISPATCH DISPATCH_RECTANGLE
#endif
#ifndef ORTHO
#define ORTHO 0 // 1: rays are parallel
#endif

// Small differences remain specialisation constants.
#if REPEATED
layout(constant_id = 0) const uint CELLS = 0u; // 1: the box holds several replicas
#else
const uint CELLS = 0u;
#endif
#if SHADOWED
layout(constant_id = 1) const uint SHADOW = 0u; // one of SHADOW_*
#else
const uint SHADOW = 0u;
#endif
#if TEXTURED
layout(constant_id = 2) const uint COLOR_MAP = 0u; // 1: colours come from a map
layout(constant_id = 3) const uint BUMP = 0u; // one of BUMP_*
#endif
#if TEXTURED || OUTPUT == OUTPUT_PLANES
layout(constant_id = 4) const uint PROJECTION = 2u; // one of PROJECTION_*
#endif
layout(constant_id = 5) const uint REFINEMENT = 0u; // of the linear search: one of REFINEMENT_*
layout(constant_id = 6) const uint DEPTH_TEST = 1u; // 0: nothing was drawn before, whose depth would have to be compared
layout(constant_id = 7) const uint DEPTH_KEEP = 1u; // 0: nothing will be drawn after, that would ask for depths
layout(constant_id = 8) const uint MORE_LIGHTS = 0u; // 1: there may be more than two
#if SEARCH == SEARCH_QUADRIC && DISPATCH != DISPATCH_BEAMS || SEARCH == SEARCH_NONE
// 1: the box cuts nothing of the solid, and the eye is outside of it, as that of hulls and tiles always is.
layout(constant_id = 11) const uint OUTSIDE = 0u;
#else
const uint OUTSIDE = 0u;
#endif
#if SEARCH == SEARCH_QUADRIC && DISPATCH == DISPATCH_RECTANGLE
layout(constant_id = 12) const uint CUT = 0u; // which part of a solid that its box cuts: one of CUT_*
#else
const uint CUT = 0u;
#endif
// Of one solid's tables: most that the device's uniform buffers hold.
layout(constant_id = 13) const uint OWN_VECTORS = 1024u;
layout(constant_id = 15) const uint LARGE_POINTS = 1u; // 1: the device draws points of 1 to 8 pixels a side
#if SEARCH == SEARCH_CIRCLE
layout(constant_id = 10) const uint PAPERS_STEPS = 0u; // bound of the papers' loop; 0: what the solid's block says
#endif
#if DISPATCH == DISPATCH_LISTS
layout(constant_id = 9) const uint LIST_LENGTH = 8u; // of DISPATCH_LISTS: patches that a pixel tests
layout(constant_id = 14) const uint ALONE = 0u; // 1: tiles are bins of one copy, each of any of the batch's instances
#endif

const uint CUT_ANY = 0u; // any part of any solid
const uint CUT_TILES = 1u; // compute: tiles that beams have listed
const uint CUT_SOLID = 2u; // rays that enter box and solid at once: of the sides, or of tiles that beams have listed

const uint REFINEMENT_NONE = 0u;
const uint REFINEMENT_HALVINGS = 1u;
const uint REFINEMENT_SECANTS = 2u;

const uint PROJECTION_PLANAR = 1u;
const uint PROJECTION_CYLINDRICAL = 2u;
const uint PROJECTION_SPHERICAL = 3u;
const uint PROJECTION_ARC = 4u;

const uint BUMP_OFF = 0u;
const uint BUMP_SURFACE_GRADIENT = 1u;
const uint BUMP_PAPERS = 2u;

const uint SHADOW_OFF = 0u;
const uint SHADOW_HARD = 1u;
const uint SHADOW_SOFT = 2u;

const uint EXHAUSTED_BIT = 2147483648u; // of a pixel's word of look-ups: a ray of it ran out of steps

const uint MAX_LIGHTS = 8u;
const uint PATCH_VECTORS = 1024u; // least OWN_VECTORS: what every device's uniform buffers hold
const uint MOST_OWN_VECTORS = 4096u;
const uint PATCH_ROWS = 256u; // of a solid's tables: a power of 4
const uint PATCH_NODES = 340u; // of the tree over them: 256 + 64 + 16 + 4
const uint BEAM_NODES = 64u; // of one of its levels
const uint BEAM_FIRST_NODE = 256u; // where that begins
const uint HULL_SIDES = 12u; // corners of a hull's rings
const uint PATCHES_PER_CELL = 8u; // most patches of a hull's cell
const uint SIDE_ROWS = 32u; // strips of each of the box's sides that cut a hull
const uint FRUSTUM_VECTORS = 17u; // of a frustum: its rings, then the cell's quadrics and guards
const uint LISTED_PATCHES = 340u; // most patches of a solid of which lists are made, three vectors each
const uint LIST_LENGTHS = 4u; // different lengths of lists of a tile's patches
const uint TILE_LISTS = 5u; // lists of tiles: one for each, and one of tiles whose rays enter box and solid at once
const uint SOLID_ROWS = 64u; // rows of equal height of which it is known within which radius all is solid
const uint SHORT_LIST = 8u; // the first of them
const uint MIDDLE_LIST = 16u;
const uint LONG_LIST = 32u;
const uint LONGEST_LIST = 48u;
const uint MAX_SHADOW_BATCHES = 64u; // batches of a scene with shadows
const uint MAX_SHADOW_MAPS = 12u; // different shape maps of a scene with shadows
const uint GROUP_PIXELS = 8u; // side of a compute workgroup, and of a bin
const uint SQUARE_BITS = 15u; // of either coordinate of a square's corner
const uint BIN_SPLIT = 2147483648u; // in place of a bin's count: each of its pixels has a list of its own

#endif
