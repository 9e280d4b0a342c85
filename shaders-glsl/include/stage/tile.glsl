// State of a tile with a single copy.
#ifndef TILE_GLSL
#define TILE_GLSL
#include "stage/stores.glsl"

uvec4 tile_record; // corner, index of the instance; then the runs of its listed patches, or its span (float bits)
Instance tile_instance;
Look tile_look;
PixelRays tile_rays;

// Returns true if the dispatch reads a bin. Otherwise it reads records of tiles.
bool reads_bin()
{
    return pushed.count != 0u;
}

// Loads the record.
void take_record()
{
    uint at = 4u * gl_WorkGroupID.x;
    if (reads_bin()) {
        at += bin_records(pushed.bin);
        tile_record = uvec4(bin_words[at], bin_words[at + 1u], bin_words[at + 2u], bin_words[at + 3u]);
    } else {
        at += 4u * pushed.first;
        tile_record = uvec4(tile_words[at], tile_words[at + 1u], 0u, 0u);
    }
}

// Index of the tile's instance among all. It is the same for all lanes if it is not read from memory.
uint instance_number()
{
    return ONE_OBJECT == 2u ? pushed.instance : tile_record.y;
}

uvec2 tile_corner()
{
    return uvec2(tile_record.x & 0xffffu, tile_record.x >> 16);
}

// Computes look and rays from the instance and its object.
void begin_tile()
{
    tile_look = look_of(tile_instance, instance_number());
    tile_rays = pixel_rays(tile_instance);
}

void store_tile(uvec2 pixel, bool found, Hit hit)
{
    float depth = depth_of(tile_rays.base + hit.t);
    if (all(lessThan(pixel, frame.size.xy))) {
        count_steps(pixel, hit);
        if (found && (DEPTHS == 0u || depth < drawn_depth(pixel))) {
            store(pixel, depth, shade(tile_look, tile_rays, pixel, hit));
        }
    }
}

#endif
