#version 450
#extension GL_GOOGLE_include_directive : require
// Lists the copies of a hierarchy that the rays of each tile may meet, an invocation a tile. Where there is one copy, the
// patches that the rays may hit are listed. If all such tiles of a work group have the same instance, the invocations
// first test all patches against a beam around these tiles. Each invocation then tests only the remaining patches
// against its own tile.
#define BIN_ACCESS
#define MAKES_LISTS
#include "stage/patch_runs.glsl"
#include "stage/beam.glsl"

const uint MET_WORDS = (LISTED_PATCHES + 31u) / 32u;
const uint TILES = GROUP_PIXELS * GROUP_PIXELS;
shared uint met[MET_WORDS]; // one bit per patch
shared uint low_x, low_y, high_x, high_y; // bounds of the corners of the group's tiles of one copy, pixels
shared uint low_copy, high_copy; // bounds of their instances

// Returns true if a ray of the tile may enter a copy.
bool shows_copy(uint number, uvec2 corner)
{
    Instance instance = instances[number];
    load(instance);
    PixelRays rays = pixel_rays(instance);
    uvec4 header = listed_header();
    Beam beam = beam_of(rays, corner, GROUP_PIXELS, farthest_of(rays, instance), uintBitsToFloat(header.y));
    bool meets = false;
    vec2 unused;
    for (uint k = 0u; k < header.x && !meets; ++k) {
        meets = may_meet(beam, k, unused);
    }
    return meets;
}

void main()
{
    load_frame(pushed.object);
    load_grid();
    uint self = gl_LocalInvocationIndex;
    uvec2 corner;
    bool present = tile_of_block(corner);
    TileWalk tile = walk_of_tile(pushed.root, corner);
    if (ONE_OBJECT != 2u && (tile.first.y != 0u || tile.node != 0u)) {
        uvec4 first = tile.first;
        tile.first = uvec4(0u);
        uint count = 0u;
        for (uint k = 0u; k < MOST_FIRST; ++k) {
            if (first[k] != 0u && shows_copy(node_at(pushed.root + first[k]).index, corner)) {
                tile.first[count] = first[k];
                ++count;
            }
        }
    }
    bool single = present && tile.first.x != 0u && tile.first.y == 0u && tile.node == 0u;
    uint number = pushed.instance;
    if (ONE_OBJECT != 2u && single) {
        number = node_at(pushed.root + tile.first.x).index;
    }
    if (self == 0u) {
        low_x = low_y = low_copy = 0xffffffffu;
        high_x = high_y = high_copy = 0u;
    }
    barrier();
    if (single) {
        atomicMin(low_x, corner.x);
        atomicMin(low_y, corner.y);
        atomicMax(high_x, corner.x);
        atomicMax(high_y, corner.y);
        if (ONE_OBJECT != 2u) {
            atomicMin(low_copy, number);
            atomicMax(high_copy, number);
        }
    }
    barrier();
    bool some = low_x <= high_x;
    bool shares = some && (ONE_OBJECT == 2u || low_copy == high_copy);
    // Invocations without a tile of one copy take part in the test of the group's beam.
    number = single || !shares || ONE_OBJECT == 2u ? number : low_copy;
    Instance instance = instances[number];
    load(instance);
    PixelRays rays = pixel_rays(instance);
    float farthest = farthest_of(rays, instance);
    uvec4 header = listed_header();
    float unit = uintBitsToFloat(header.y);
    if (self < MET_WORDS) {
        met[self] = shares ? 0u : 0xffffffffu;
    }
    barrier();
    if (shares) {
        uint side = max(high_x - low_x, high_y - low_y) + GROUP_PIXELS;
        Beam wide = beam_of(rays, uvec2(low_x, low_y), side, farthest, unit);
        vec2 unused;
        for (uint k = self; k < header.x; k += TILES) {
            if (may_meet(wide, k, unused)) {
                atomicOr(met[k >> 5], 1u << (k & 31u));
            }
        }
    }
    barrier();

    Beam beam = beam_of(rays, corner, GROUP_PIXELS, farthest, unit);
    bool cut = false;
    vec2 outer, inner;
    cut_by_box(beam, outer, inner); // tiles of rays that may be cut use the tree
    PatchRuns runs = NO_PATCHES;
    for (uint w = 0u; w << 5 < header.x; ++w) {
        uint rest = single ? met[w] : 0u;
        while (rest != 0u) {
            uint k = w << 5 | uint(findLSB(rest));
            rest &= rest - 1u;
            vec2 span;
            bool meets = k < header.x && may_meet(beam, min(k, header.x), span) && span.x <= outer.y;
            cut = cut || meets && span.x < inner.x;
            take_patch(runs, k, meets);
        }
    }
    // Rays begin at the height of a tip that they would not hit precisely from elsewhere. If there are two, the tile uses
    // the tree.
    float start = height_of_start(beam);
    bool by_tip = false;
    uint last = min(runs.last, header.w >> 16);
    for (uint round = 0u; round < 1u + uint(by_tip); ++round) {
        for (uint k = max(runs.first, header.w & 0xffffu); k <= last; ++k) {
            bool listed = runs.any && (k <= runs.gap.x || k >= runs.gap.y);
            bool imprecise = listed && is_imprecise(beam, k, start, uintBitsToFloat(header.z));
            cut = cut || imprecise && (by_tip || !is_steeper(beam, k));
            by_tip = by_tip || imprecise;
            start = imprecise ? anchor_of(k) : start;
        }
    }
    bool shows = single ? runs.any && outer.x <= outer.y : present && !is_empty(tile);
    if (shows && (!single || cut || !append_runs(corner, number, runs, by_tip, start))) {
        uint first = pushed.tiles + WALK_BIN * pushed.room;
        append_walk(pushed.heads + WALK_BIN, first, corner, tile);
    }
}
