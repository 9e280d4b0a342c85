// State of a tile with a single copy.
#ifndef TILE_GLSL
#define TILE_GLSL
#include "stage/stores.glsl"

BinTile tile; // `found` is set for tiles of bins alone
Instance tile_instance;
Look tile_look;
PixelRays tile_rays;

// Returns true if the dispatch reads a bin. Otherwise it reads tiles from the host.
bool reads_bin()
{
    return pushed.count != 0u;
}

void load_tile()
{
    if (reads_bin()) {
        tile = bin_tiles[bin_start(pushed.bin) + gl_WorkGroupID.x];
    } else {
        CopyTile from_host = copy_tiles[pushed.first + gl_WorkGroupID.x];
        tile = BinTile(from_host.square, from_host.instance, uvec2(0u));
    }
}

// Index of the tile's instance among all. It is the same for all lanes if it is not read from memory.
uint instance_number()
{
    return ONE_OBJECT == 2u ? pushed.instance : tile.instance;
}

uvec2 tile_corner()
{
    return square_corner(tile.square);
}

// Computes look and rays from the instance and its object.
void begin_tile()
{
    tile_look = look_of(tile_instance, instance_number());
    tile_rays = pixel_rays(tile_instance);
}

void store_tile(uvec2 pixel, bool found, Hit hit)
{
    float depth = depth_of(tile_rays.base + hit.t, lagging_terms(tile_instance.lag));
    if (all(lessThan(pixel, frame.size))) {
        count_steps(pixel, hit);
        if (found && (DEPTHS == 0u || depth < drawn_depth(pixel))) {
            store(pixel, depth, shade(tile_look, tile_rays, pixel, hit));
        }
    }
}

#endif
