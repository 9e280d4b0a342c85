#version 450
#extension GL_GOOGLE_include_directive : require
// Computes the record of every copy of a crowd relative to the eye, in double precision like instance_block() of
// src/gpu/resources/block.rs, and lists the copies that some pixel may show. One invocation per copy.
#define INSTANCE_ACCESS
#include "stage/crowd.glsl"

const uint PLACEMENT_WORDS = 20u;
layout(set = 2, binding = 7, std430) readonly buffer Placements {
    uint placement_words[]; // position, unit quaternion, scale: ten doubles each
};

double placed(uint copy, uint n)
{
    uint at = PLACEMENT_WORDS * copy + 2u * n;
    return packDouble2x32(uvec2(placement_words[at], placement_words[at + 1u]));
}

#define TRIPLE(of) dvec3(packDouble2x32(of[0].xy), packDouble2x32(of[0].zw), packDouble2x32(of[1].xy))

dvec3 turned(dvec4 q, dvec3 v)
{
    dvec3 t = 2.0lf * cross(q.xyz, v);
    return v + q.w * t + cross(q.xyz, t);
}

// Returns true if no pixel shows a cylinder around the eye, or beside it.
bool is_beyond(Axes axes, vec3 cylinder)
{
    vec2 low = vec2(crowd.row_y.w, crowd.row_z.w);
    vec2 high = crowd.limits.xy;
    vec3 discs[2] = vec3[2](axes.middle + axes.z * cylinder.y, axes.middle + axes.z * cylinder.z);
    vec2 before = vec2(-3e38);
    vec2 behind = vec2(-3e38);
    for (uint k = 0u; k < 2u; ++k) {
        before = max(before, discs[k].xy - low * discs[k].z);
        behind = max(behind, high * discs[k].z - discs[k].xy);
    }
    vec2 x = axes.x.xy - low * axes.x.z;
    vec2 y = axes.y.xy - low * axes.y.z;
    before += cylinder.x * sqrt(x * x + y * y);
    x = axes.x.xy - high * axes.x.z;
    y = axes.y.xy - high * axes.y.z;
    behind += cylinder.x * sqrt(x * x + y * y);
    return any(lessThan(before, vec2(0.0))) || any(lessThan(behind, vec2(0.0)));
}

void main()
{
    uint copy = 64u * (gl_WorkGroupID.x + 32768u * gl_WorkGroupID.y) + gl_LocalInvocationIndex;
    if (copy >= crowd.counts.x) {
        return;
    }
    uint n = 0u;
    for (uint high = crowd.size.w; n + 1u < high;) {
        uint middle = (n + high) >> 1;
        bool later = copy >= crowd.objects_of[middle].copies.x;
        n = later ? middle : n;
        high = later ? high : middle;
    }
    uvec4 axis = crowd.objects_of[n].axis;
    vec4 shape = crowd.objects_of[n].shape;
    vec3 cylinder = vec3(shape.z, crowd.objects_of[n].heights.xy);
    uvec4 numbers = crowd.objects_of[n].copies;
    uvec4 pieces = crowd.objects_of[n].pieces;

    dvec3 p = dvec3(placed(copy, 0u), placed(copy, 1u), placed(copy, 2u)) - TRIPLE(crowd.eye);
    dvec4 q = dvec4(placed(copy, 3u), placed(copy, 4u), placed(copy, 5u), placed(copy, 6u));
    dvec3 s = dvec3(placed(copy, 7u), placed(copy, 8u), placed(copy, 9u));
    dvec3 middle = p + turned(q, s * dvec3(0.0lf, 0.0lf, 0.5lf));
    double depth = dot(middle, TRIPLE(crowd.forward));
    dvec3 to_plane = TRIPLE(crowd.dir_00) * max(depth, 0.0lf);
    dvec3 origin = turned(dvec4(-q.xyz, q.w), to_plane - p) / s - dvec3(packDouble2x32(axis.xy), packDouble2x32(axis.zw), 0.0lf);
    Instance i;
    i.position_sx = vec4(vec3(p), float(s.x));
    i.rotation = vec4(q);
    i.scale_depth = vec4(float(s.y), float(s.z), float(depth), float(dot(TRIPLE(crowd.clip_x), middle)));
    i.origin = vec4(vec3(origin), float(dot(TRIPLE(crowd.clip_y), middle)));
    i.object = uvec4(numbers.w, pieces.x, n, 0u);

    Axes axes = axes_of(i, shape.xy);
    vec2 depths = depths_of(axes, cylinder);
    ivec4 pixels = crowd.picture;
    bool shows = depths.y > 0.0;
    if (depths.x > 1e-3 * depths.y) {
        pixels = pixels_of(axes, cylinder);
    } else {
        shows = shows && !is_beyond(axes, cylinder);
    }
    if (!shows || pixels.x > pixels.z || pixels.y > pixels.w) {
        return;
    }
    uint number = numbers.z + copy - numbers.x;
    instances[number] = i;
    uint near = floatBitsToUint(max(depths.x * (1.0 - 1e-5), 0.0));
    atomicMax(bin_words[head_word(LEAST_NEAR)], ~near);
    atomicMax(bin_words[head_word(MOST_NEAR)], near);
    uint place = count_up(head_word(VISIBLE_GROUPS), 0xffffffffu);
    uint at = crowd.lists.z + VISIBLE_WORDS * place;
    bin_words[at] = number;
    bin_words[at + 1u] = near;
    bin_words[at + 2u] = uint(pixels.x) | uint(pixels.y) << 16;
    bin_words[at + 3u] = uint(pixels.z) | uint(pixels.w) << 16;
    // The queue of all copies, for an overflow.
    at = crowd.tiles.y + 4u * place;
    tile_words[at] = number;
    tile_words[at + 1u] = near;
    tile_words[at + 2u] = 0xffffffffu;
    tile_words[at + 3u] = 0xffffffffu;
}
