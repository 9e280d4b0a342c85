// The variant: what a pipeline is specialised for. build.rs generates the same names for Rust from this file.
#ifndef VARIANT_GLSL
#define VARIANT_GLSL

layout(constant_id = 0) const uint SOLVER = 0u;     // one of SOLVER_*
layout(constant_id = 1) const uint MAP_FORMAT = 1u; // one of FORMAT_*
layout(constant_id = 2) const uint MAX_STEPS = 20u; // bound of the search's loop
layout(constant_id = 3) const uint OFFSET = 0u;     // one of OFFSET_*
layout(constant_id = 4) const uint CELLS = 0u;      // 1: the box holds several replicas
layout(constant_id = 5) const uint PROJECTION = 2u; // one of PROJECTION_*
layout(constant_id = 6) const uint COLOR_MAP = 0u;  // 1: colours come from a map
layout(constant_id = 7) const uint BUMP = 0u;       // one of BUMP_*
layout(constant_id = 8) const uint SHADOW = 0u;     // one of SHADOW_*
layout(constant_id = 9) const uint LIGHTS = 1u;     // number of lights: a loop of known length costs software drivers a third
layout(constant_id = 10) const uint OWN_TABLES = 0u; // 1: the batch's pieces fit into a uniform buffer
layout(constant_id = 11) const uint SINGLE = 0u;    // 1: what is drawn is one instance, which the block holds

layout(constant_id = 12) const uint AHEAD = 0u;     // 1: where rays begin comes from beam.comp, and where they end and which tiles, or from a convex hull
layout(constant_id = 13) const uint DEPTH_TEST = 1u; // 0: nothing was drawn before, whose depth would have to be compared
layout(constant_id = 14) const uint DEPTH_KEEP = 1u; // 0: nothing will be drawn after, that would ask for depths
layout(constant_id = 15) const uint TESTS = 8u;     // pieces of the hull's largest cell, at most HULL_TESTS

const uint SOLVER_CIRCLE = 0u; // the papers' loop
const uint SOLVER_LIVE = 1u;   // steps that are safe to a texel and a last secant, on the map alone

const uint SOLVER_QUADRIC = 2u; // exact pieces of quadrics, rebuilt when parameters change

const uint SOLVER_LINEAR = 3u; // equal steps
const uint SOLVER_RELIEF = 4u; // equal steps, then halvings
const uint SOLVER_SECANT = 5u; // equal steps, then secants

const uint SOLVER_CONE = 6u; // empty cones on each row, for solids that are single-valued in z
const uint SOLVER_RELAXED = 7u; // the same, relaxed, and halvings
const uint SOLVER_MESH = 15u; // triangles: nothing is searched

const uint FORMAT_RGBA8 = 0u; // the papers' texture, unsigned distance
const uint FORMAT_SIGNED = 1u; // one channel of signed distance, 16 or 32 bits

const uint OFFSET_NONE = 0u; // w = 0
const uint OFFSET_EXTENDED = 1u; // w = e
const uint OFFSET_BEVELED = 2u; // w = e + b min(u, c)

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
const uint LOOK_LIGHTS = 2u; // whose colours and ways vertices hand to fragments; others are read there
const uint PIECE_VECTORS = 1024u; // of one solid's tables: what every device's uniform buffers hold
const uint PIECE_ROWS = 256u; // of a solid's tables: a power of 4
const uint PIECE_NODES = 340u; // of the tree over them: 256 + 64 + 16 + 4
const uint BEAM_NODES = 64u; // of one of its levels
const uint BEAM_FIRST_NODE = 256u; // where that begins
const uint HULL_SIDES = 12u; // corners of a hull's rings
const uint HULL_TESTS = 8u; // most pieces of a hull's cell
const uint BAND_VECTORS = 17u; // of a band: its rings, then the cell's quadrics and guards
const uint MAX_SHADOW_BATCHES = 64u; // batches of a scene with shadows
const uint MAX_SHADOW_MAPS = 12u; // different shape maps of a scene with shadows
const uint BIN_PIXELS = 32u; // side of a compute bin
const uint GROUP_PIXELS = 8u; // side of a compute workgroup

#endif
