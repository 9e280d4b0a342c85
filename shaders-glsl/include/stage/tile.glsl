// A tile of one copy. The work group shares its instance: software drivers read shared memory at constant places once
// for all lanes.
#ifndef TILE_GLSL
#define TILE_GLSL
#include "stage/compute.glsl"
#include "core/look.glsl"
#include "core/pixel_ray.glsl"
#include "stage/stores.glsl"

const uint INSTANCE_WORDS = 20u;
layout(set = 0, binding = 2, std430) readonly buffer InstanceWords {
    uint instance_words[];
};

shared uint tile_record[3]; // corner, number of the instance, runs of its listed patches
shared uint tile_instance[INSTANCE_WORDS];
Look tile_look;
PixelRays tile_rays;

// Shares what share_instance() reads after a barrier.
void share_record()
{
    uint n = gl_LocalInvocationIndex;
    if (n < 3u) {
        tile_record[n] = LIST_LENGTH != 0u ? list_words[list_tiles(pushed.list) + 4u * gl_WorkGroupID.x + n]
                                           : tile_words[4u * (pushed.first + gl_WorkGroupID.x) + n];
    }
}

uvec2 tile_corner()
{
    return uvec2(tile_record[0] & 0xffffu, tile_record[0] >> 16);
}

// Shares what begin_tile() reads after a barrier.
void share_instance()
{
    if (gl_LocalInvocationIndex < INSTANCE_WORDS) {
        tile_instance[gl_LocalInvocationIndex] = instance_words[INSTANCE_WORDS * tile_record[1] + gl_LocalInvocationIndex];
    }
}

vec4 instance_vector(uint n)
{
    uint at = 4u * n;
    return uintBitsToFloat(uvec4(tile_instance[at], tile_instance[at + 1u], tile_instance[at + 2u], tile_instance[at + 3u]));
}

// Takes over frame, instance and solid.
void begin_tile()
{
    uint number = tile_instance[16];
    Instance i = Instance(instance_vector(0u), instance_vector(1u), instance_vector(2u), instance_vector(3u), uvec4(number));
    take_frame();
    take_solid(number);
    take_lights();
    tile_look = look_of(i);
    tile_rays = pixel_rays(i);
}

void store_tile(uvec2 pixel, bool found, Nearest nearest)
{
    if (all(lessThan(pixel, frame.size.xy))) {
        count_steps(pixel, nearest);
        if (found && (DEPTH_TEST == 0u || nearest.depth < drawn_depth(pixel))) {
            keep_depth(pixel, nearest);
            store(pixel, shade(tile_look, tile_rays, pixel, nearest.hit));
        }
    }
}

#endif
