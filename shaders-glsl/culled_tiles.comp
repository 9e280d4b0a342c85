#version 450
#extension GL_GOOGLE_include_directive : require
// Traces a solid of one copy. A work group first culls the patches that no ray of its square of pixels may meet, then
// for each of its tiles those that no ray of the tile may. Each pixel solves what is left for its tile, in order. Tiles
// of rays that the sides of the box may cut, or for which rounding decides, walk the tree.
#define SINGLE
#define UNSHADOWED
#define STORED_TREE
#define GROUP_SIDE CULLED_PIXELS
#include "stage/stores.glsl"
#include "stage/beam.glsl"
#include "search/patch_row.glsl"

const uint MET_WORDS = (LISTED_PATCHES + 31u) / 32u;
const uint PIXELS = GROUP_PIXELS * GROUP_PIXELS; // of a tile
const uint TILES = GROUP_SIDE * GROUP_SIDE / PIXELS; // of a group
shared uint met[MET_WORDS]; // one bit per patch
shared uint met_by_tile[TILES * MET_WORDS];
shared uint tree_tiles; // one bit per tile

// Finds the patches that rays of a tile may meet. `lane`: of the invocations of the tile, each of which tests some.
void cull(Beam beam, uvec4 header, uint tile, uint lane)
{
    vec2 outer, inner;
    cut_by_box(beam, outer, inner);
    float start = height_of_start(beam);
    for (uint k = lane; k < header.x; k += PIXELS) {
        vec2 span;
        if ((met[k >> 5] >> (k & 31u) & 1u) != 0u && may_meet(beam, k, span) && span.x <= outer.y) {
            atomicOr(met_by_tile[MET_WORDS * tile + (k >> 5)], 1u << (k & 31u));
            bool tip = k >= (header.w & 0xffffu) && k <= header.w >> 16;
            if (span.x < inner.x || tip && is_imprecise(beam, k, start, uintBitsToFloat(header.z))) {
                atomicOr(tree_tiles, 1u << tile);
            }
        }
    }
}

// Solves the patches that are left for a tile.
bool search_culled(PixelRays rays, vec2 pixel, uint tile, out Hit hit)
{
    PatchRow row = begin_row(rays, pixel, middle_of(rays, pixel));
    if (!is_outside()) {
        clip_to_sides(row);
    }
    uint count = 0u;
    for (uint w = 0u; w < MET_WORDS; ++w) {
        uint rest = met_by_tile[MET_WORDS * tile + w];
        while (rest != 0u) {
            uint at = 1u + 3u * (w << 5 | uint(findLSB(rest)));
            rest &= rest - 1u;
            vec4 quadric = uintBitsToFloat(listed_table(at));
            vec4 guard = uintBitsToFloat(listed_table(at + 1u));
            take_nearer(row.m, quadric, guard, row.least, row.best, row.quadric);
            ++count;
        }
    }
    return end_row(row, count, hit);
}

void main()
{
    load_frame(pushed.object);
    Instance instance = instances[pushed.instance];
    load(instance);
    PixelRays rays = pixel_rays(instance);
    uint self = gl_LocalInvocationIndex;
    uint tile = self / PIXELS;
    for (uint w = self; w < TILES * MET_WORDS; w += GROUP_SIDE * GROUP_SIDE) {
        met_by_tile[w] = 0u;
    }
    if (self < MET_WORDS) {
        met[self] = 0u;
    }
    if (self == 0u) {
        tree_tiles = 0u;
    }
    barrier();
    uint across = squares_of_rectangle().x;
    uint number = pushed.first + gl_WorkGroupID.x;
    uvec2 square = square_corner(pushed.corner) + GROUP_SIDE * uvec2(number % across, number / across);
    uvec4 header = listed_header();
    float farthest = farthest_of(rays, instance);
    float unit = uintBitsToFloat(header.y);
    Beam wide = beam_of(rays, square, GROUP_SIDE, farthest, unit);
    vec2 unused;
    for (uint k = self; k < header.x; k += GROUP_SIDE * GROUP_SIDE) {
        if (may_meet(wide, k, unused)) {
            atomicOr(met[k >> 5], 1u << (k & 31u));
        }
    }
    barrier();
    uvec2 corner = square + GROUP_PIXELS * uvec2(tile & 1u, tile >> 1);
    cull(beam_of(rays, corner, GROUP_PIXELS, farthest, unit), header, tile, self % PIXELS);
    barrier();
    uvec2 pixel = corner + pixel_of_tile(self % PIXELS);
    uvec4 picture = frame_block.picture; // a square may reach beyond its rows
    if (all(lessThan(pixel - picture.xy, picture.zw))) {
        Hit hit = NO_HIT;
        bool found;
        if ((tree_tiles >> tile & 1u) != 0u) {
            RayStart start = FROM_EYE;
            found = trace(ray_origin(rays, vec2(pixel)), ray_direction(rays, vec2(pixel)), rays.base, start, hit);
        } else {
            found = search_culled(rays, vec2(pixel), tile, hit);
        }
        store_nearer(pixel, look_of(instance, pushed.instance), rays, instance.lag, found, hit);
    }
}
