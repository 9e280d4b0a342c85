#version 450
#extension GL_GOOGLE_include_directive : require
// Traces pixels: the nearest copy of a hierarchy. REPEATED: it may hold replicas.
#ifndef REPEATED
#define SINGLE
#endif
#include "stage/stores.glsl"
#include "stage/walk.glsl"
#include "stage/walk_lists.glsl"

layout(set = 2, binding = 1, std430) readonly buffer OpenPixelBlock {
    uint open_pixels[]; // x | y << 16, or NO_PIXEL
};

void main()
{
    load_frame(pushed.object);
    load_grid();
    if (ONE_OBJECT == 2u) {
        only_copy = instances[pushed.instance];
    }
    uint number = pushed.first + gl_WorkGroupID.x;
    TileWalk tile = FROM_ROOT;
    uvec2 pixel;
    if (pushed.walks == WALKS_OPEN) {
        uint before = GROUP_PIXELS * GROUP_PIXELS * gl_WorkGroupID.x;
        uint position = open_pixels[pushed.first + before + gl_LocalInvocationIndex];
        pixel = uvec2(position & 0xffffu, position >> 16);
    } else {
        uint across = squares_of_rectangle().x;
        uvec2 corner = square_corner(pushed.corner) + GROUP_PIXELS * uvec2(number % across, number / across);
        if (pushed.walks == WALKS_LISTED) {
            uint at = pushed.tiles + TILE_WALK_VECTORS * gl_WorkGroupID.x;
            uvec4 rest = tile_walks[at + 1u];
            corner = square_corner(rest.w);
            if (ONE_OBJECT != 2u) {
                tile = TileWalk(tile_walks[at], rest.x, rest.y, uintBitsToFloat(rest.z), 0.0);
            }
        }
        pixel = corner + pixel_of_tile(gl_LocalInvocationIndex);
    }
    if (all(lessThan(pixel, frame.size))) {
        Nearest nearest = nothing_nearer_than(drawn_depth(pixel));
        walk(pushed.root, vec2(pixel), tile, nearest);
        count_steps(pixel, nearest.hit);
        if (nearest.found) {
            Instance i;
            if (ONE_OBJECT == 2u) {
                i = only_copy;
            } else {
                i = instance_at(nearest.index);
            }
            load(i);
            store(pixel, nearest.depth, shade(look_of(i, nearest.index), pixel_rays(i), pixel, nearest.hit));
        }
    }
}
