// The first copies of a hierarchy that the rays of a tile may meet, and the place where the walks of its pixels go on.
#ifndef TILE_WALK_GLSL
#define TILE_WALK_GLSL
#include "core/pixel_ray.glsl"

const float NEVER = 3e38; // in place of the depth at which rays enter a box

// Where the walks of a tile's pixels begin.
struct TileWalk {
    uvec4 first; // nodes of the first copies, nearest first; 0 after the last
    uint node; // the next node; 0 if all copies are listed
    uint trail; // of this node, as in walk.glsl
    float rest; // depth before which no copy is met that is not listed
    float near; // depth before which no copy is met
};

// A walk without a list.
const TileWalk FROM_ROOT = TileWalk(uvec4(0u), 1u, 0u, 0.0, 0.0);

const uint MOST_FIRST = 4u; // copies in a list

bool is_empty(TileWalk tile)
{
    return tile.first.x == 0u && tile.node == 0u;
}

// Returns the node that follows at the end of a way, or 0; `trail` becomes that node's.
uint next_node(uint node, inout uint trail)
{
    uint up = uint(max(findLSB(trail), 0));
    uint next = trail == 0u ? 0u : node >> up ^ 1u;
    trail = trail >> up & ~1u;
    return next;
}

// The rays of a tile: from the eye in directions between two, along each axis.
struct TileRays {
    vec3 inverse_most; // steps of the grid over the largest part of a direction
    vec3 inverse_least;
    bvec3 most_up; // true where the largest part is positive
    bvec3 least_up;
};

// The eye and the unit of the grid of hierarchies. Set by load_grid() after load_frame(), as soon: see blocks.glsl.
vec3 grid_unit;
vec3 grid_low;
vec3 grid_high;

void load_grid()
{
    grid_unit = frame_block.eye.grid_unit;
    grid_low = frame_block.eye.grid_low;
    grid_high = frame_block.eye.grid_high;
}

// Returns the rays of all pixels and samples of a tile.
TileRays tile_rays_of(uvec2 corner)
{
    vec2 middle = vec2(corner) + 0.5 * float(GROUP_PIXELS - 1u);
    vec3 way = frame.dir_00 + middle.x * frame.dir_x + middle.y * frame.dir_y;
    vec3 beside = 0.5 * float(GROUP_PIXELS) * (abs(frame.dir_x) + abs(frame.dir_y)) + 4e-7 * abs(way);
    vec3 most = way + beside;
    vec3 least = way - beside;
    most = mix(most, vec3(1e-20), lessThan(abs(most), vec3(1e-20)));
    least = mix(least, vec3(-1e-20), lessThan(abs(least), vec3(1e-20)));
    return TileRays(grid_unit / most, grid_unit / least, greaterThan(most, vec3(0.0)), greaterThan(least, vec3(0.0)));
}

// Returns a depth before which no ray enters a node's box, or NEVER if none does.
float tile_entry_of(WalkNode node, TileRays rays)
{
    vec3 a = vec3(node.bounds & 0xffffu) - grid_low;
    vec3 b = vec3(node.bounds >> 16) - grid_high;
    vec3 a_most = mix(vec3(-NEVER), a * rays.inverse_most, rays.most_up);
    vec3 near = max(a_most, mix(b * rays.inverse_least, vec3(-NEVER), rays.least_up));
    vec3 b_least = mix(vec3(NEVER), b * rays.inverse_least, rays.least_up);
    vec3 far = min(b_least, mix(a * rays.inverse_most, vec3(NEVER), rays.most_up));
    float enter = max(max(near.x, near.y), max(near.z, 0.0));
    return enter <= min(far.x, min(far.y, far.z)) ? enter : NEVER;
}

// Returns the walk of the tile with this corner, in pixels. `root`: index of the hierarchy.
TileWalk walk_of_tile(uint root, uvec2 corner)
{
    TileRays rays = tile_rays_of(corner);
    uint leaves = node_at(root).index;
    TileWalk tile = TileWalk(uvec4(0u), 1u, 0u, NEVER, NEVER);
    uint count = 0u;
    do {
        bool ends = tile.node >= leaves;
        uint pair = root + (ends ? tile.node : 2u * tile.node);
        WalkNode first = node_at(pair);
        float to_first = tile_entry_of(first, rays);
        float to_second = tile_entry_of(node_at(pair + 1u), rays);
        bool swaps = to_second < to_first;
        bool both = max(to_first, to_second) < NEVER;
        bool down = !ends && min(to_first, to_second) < NEVER;
        bool met = ends && to_first < NEVER && first.index != INNER_NODE;
        uvec4 places = uvec4(0u, 1u, 2u, 3u);
        tile.first = mix(tile.first, uvec4(tile.node), equal(uvec4(met ? count : MOST_FIRST), places));
        tile.near = met ? min(tile.near, to_first) : tile.near;
        count += uint(met);
        uint trail = tile.trail;
        uint next = next_node(tile.node, trail);
        tile.trail = down ? tile.trail << 1 | uint(both) : trail;
        tile.node = down ? 2u * tile.node + uint(swaps) : next;
    } while (tile.node != 0u && count < MOST_FIRST);
    uint node = tile.node;
    uint trail = tile.trail;
    while (node != 0u) {
        tile.rest = min(tile.rest, tile_entry_of(node_at(root + node), rays));
        node = next_node(node, trail);
    }
    tile.node = tile.rest < NEVER ? tile.node : 0u;
    tile.near = min(tile.near, tile.rest);
    return tile;
}

#endif
