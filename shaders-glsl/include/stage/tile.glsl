// State of a tile with a list of patches.
#ifndef TILE_GLSL
#define TILE_GLSL
#include "stage/stores.glsl"

BinTile tile;
Instance tile_instance;
Look tile_look;
PixelRays tile_rays;

void load_tile()
{
    tile = bin_tiles[pushed.tiles + gl_WorkGroupID.x];
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
    if (all(lessThan(pixel, frame.size))) {
        store_nearer(pixel, tile_look, tile_rays, tile_instance.lag, found, hit);
    }
}

#endif
