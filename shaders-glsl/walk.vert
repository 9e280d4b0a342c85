#version 450
#extension GL_GOOGLE_include_directive : require
// Points over the squares of the picture that may show a copy of a hierarchy. Devices without points of this size draw
// two triangles over the picture.
#include "stage/tile_walk.glsl"
#define VARYING out
#include "stage/walk_varyings.glsl"

void main()
{
    load_frame(0u);
    load_grid();
    uint root = uint(gl_InstanceIndex);
    uint number = uint(gl_VertexIndex);
    TileWalk tile = FROM_ROOT;
    if (LARGE_POINTS != 0u) {
        uvec2 begin = frame_block.picture.xy;
        uvec2 size = frame_block.picture.zw;
        // A point is drawn if its middle is in the picture.
        uint side = min(size.x, size.y) < GROUP_PIXELS ? 1u : GROUP_PIXELS;
        uint across = (size.x + side - 1u) / side;
        uvec2 corner = begin + min(side * uvec2(number % across, number / across), size - side);
        tile = walk_of_tile(root, corner);
        vec2 middle = (vec2(corner) + 0.5 * float(side)) * frame.clip_scale + frame.clip_shift;
        float depth = clip_depth_of(max(tile.near * (1.0 - 1e-5), 1e-30)); // the nearest that a fragment can have
        gl_Position = vec4(is_empty(tile) ? vec2(2.0) : middle, depth, 1.0);
        gl_PointSize = float(side);
    } else {
        uint bit = 1u << number;
        vec2 at = mix(vec2(-1.0), vec2(1.0), bvec2((0x32u & bit) != 0u, (0x2cu & bit) != 0u));
        gl_Position = vec4(at, frame.near_depth, 1.0);
    }
    walk_root = uvec2(root, instances[node_at(root + node_at(root).index).index].object);
    first_copies = tile.first;
    goes_on = uvec3(tile.node, tile.trail, floatBitsToUint(tile.rest));
}
