#version 450
#extension GL_GOOGLE_include_directive : require
// Lists the patches that the rays of each single-copy tile may hit. A work group processes 64 tiles. If all of them have
// the same instance, the invocations first test all patches against a beam around the whole group. Each invocation then
// tests only the remaining patches against its own tile.
#include "stage/patch_runs.glsl"
#include "stage/beam.glsl"
#include "core/meridian.glsl"

const uint MET_WORDS = (LISTED_PATCHES + 31u) / 32u;
const uint TILES = GROUP_PIXELS * GROUP_PIXELS;
shared uint met[MET_WORDS]; // one bit per patch
shared uint low_x, low_y, high_x, high_y; // bounds of the corners of the group's tiles, pixels
shared uint mixed; // 1 if the group has several instances, else 0

void main()
{
    load_frame(pushed.object);
    uint self = gl_LocalInvocationIndex;
    uint group_first = pushed.first + gl_WorkGroupID.x * TILES;
    bool present = gl_WorkGroupID.x * TILES + self < pushed.count;
    CopyTile tile = copy_tiles[present ? group_first + self : group_first];
    uvec2 corner = square_corner(tile.square);
    Instance instance = instances[ONE_OBJECT == 2u ? pushed.instance : tile.instance];
    load(instance);
    PixelRays rays = pixel_rays(instance);
    float farthest = farthest_of(rays, instance);
    uvec4 header = listed_table(0u);
    float unit = uintBitsToFloat(header.y);

    if (self == 0u) {
        low_x = low_y = 0xffffffffu;
        high_x = high_y = mixed = 0u;
    }
    barrier();
    atomicMin(low_x, corner.x);
    atomicMin(low_y, corner.y);
    atomicMax(high_x, corner.x);
    atomicMax(high_y, corner.y);
    if (ONE_OBJECT != 2u && tile.instance != copy_tiles[group_first].instance) {
        atomicOr(mixed, 1u);
    }
    barrier();
    bool shares = mixed == 0u;
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
    // If the box cuts the solid, a ray may be inside the solid before it enters the box, and then hits the cut face.
    // The tile of such a ray uses the tree.
    bool cut = false;
    vec2 outer = vec2(-1e30, 1e30);
    vec2 inner = vec2(-1e30, 1e30);
    if (!is_outside()) {
        vec4 wider = beam.width.x * vec4(-1.0, -1.0, 1.0, 1.0);
        outer = between_sides(beam.o, beam.v, sides_of_box() + wider);
        inner = between_sides(beam.o, beam.v, sides_of_box() - wider);
        // Without a ray that is sure to be between the sides, any ray may be cut.
        inner.x = inner.x <= inner.y && beam.width.x < shape.half_side ? inner.x : 1e30;
    }
    PatchRuns runs = NO_PATCHES;
    vec2 all = vec2(3e38, -3e38);
    for (uint w = 0u; w << 5 < header.x; ++w) {
        uint rest = met[w];
        while (rest != 0u) {
            uint k = w << 5 | uint(findLSB(rest));
            rest &= rest - 1u;
            vec2 span;
            bool meets = k < header.x && may_meet(beam, min(k, header.x), span) && span.x <= outer.y;
            cut = cut || meets && span.x < inner.x;
            all = meets ? vec2(min(all.x, span.x), max(all.y, span.y)) : all;
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
    bool shows = present && runs.any && outer.x <= outer.y;
    if (shows && (cut || !append_runs(tile, runs, by_tip, start))) {
        append(TREE_BIN, BinTile(tile.square, tile.instance, floatBitsToUint(all)));
    }
}
