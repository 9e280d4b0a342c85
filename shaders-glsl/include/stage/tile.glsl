// A tile of one copy. A few invocations read record and instance for all: llvmpipe 22 reads storage buffers lane by lane.
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

uvec4 tile_record; // corner, number of the instance; then the runs of its listed patches, or the bits of its span
shared uint shared_record[4];
shared uint shared_instance[INSTANCE_WORDS];
Look tile_look;
PixelRays tile_rays;

// Takes over the frame: to be called first.
void begin_frame()
{
    take_frame();
    take_lights();
    if (ONE_SOLID != 0u) {
        take_solid(pushed.solid);
    }
}

uint record_word(uint n)
{
    return LIST_LENGTH != 0u ? list_words[list_tiles(pushed.list) + 4u * gl_WorkGroupID.x + n]
                             : tile_words[4u * (pushed.first + gl_WorkGroupID.x) + n];
}

// Shares what take_shared_record() reads after a barrier.
void share_record()
{
    uint n = gl_LocalInvocationIndex;
    if (n < 4u) {
        shared_record[n] = record_word(n);
    }
}

void take_shared_record()
{
    tile_record = uvec4(shared_record[0], shared_record[1], shared_record[2], shared_record[3]);
}

// Shares what shared_copy() reads after a barrier.
void share_instance()
{
    if (gl_LocalInvocationIndex < INSTANCE_WORDS) {
        shared_instance[gl_LocalInvocationIndex] = instance_words[INSTANCE_WORDS * tile_record.y + gl_LocalInvocationIndex];
    }
}

vec4 instance_vector(uint n)
{
    uint at = 4u * n;
    return uintBitsToFloat(uvec4(shared_instance[at], shared_instance[at + 1u], shared_instance[at + 2u], shared_instance[at + 3u]));
}

Instance shared_copy()
{
    return Instance(instance_vector(0u), instance_vector(1u), instance_vector(2u), instance_vector(3u), uvec4(shared_instance[16]));
}

uvec2 tile_corner()
{
    return uvec2(tile_record.x & 0xffffu, tile_record.x >> 16);
}

// Takes over the instance and its solid.
void begin_tile(Instance i)
{
    take_solid(i.solid.x);
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
