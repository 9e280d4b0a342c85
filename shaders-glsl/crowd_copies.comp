#version 450
#extension GL_GOOGLE_include_directive : require
// COPY_BOUNDS finds the copies that some pixel may show, one invocation per copy of a crowd. COPY_RECORDS makes the
// records of those that are listed in tiles: relative to the eye, in double precision, like instance_block() of
// src/gpu/resources/block.rs.
#define INSTANCE_ACCESS
#include "stage/crowd.glsl"

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

// Returns the object of a copy.
uint object_of(uint copy)
{
    uint n = 0u;
    for (uint high = crowd.size.w; n + 1u < high;) {
        uint middle = (n + high) >> 1;
        bool later = copy >= crowd.objects_of[middle].copies.x;
        n = later ? middle : n;
        high = later ? high : middle;
    }
    return n;
}

void find_bounds(uint copy)
{
    uint n = object_of(copy);
    vec4 shape = crowd.objects_of[n].shape;
    vec3 cylinder = vec3(shape.z, crowd.objects_of[n].heights.xy);
    Axes axes = axes_of(copy, shape.xy);
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
    uint near = floatBitsToUint(max(depths.x * crowd.limits.z, 0.0));
    atomicAdd(bin_words[head_word(STEPS + step_of(near))], 1u);
    uint at = crowd.copies.x + VISIBLE_WORDS * add_to(VISIBLE, 0xffffffffu);
    bin_words[at] = copy;
    bin_words[at + 1u] = near;
    bin_words[at + 2u] = uint(pixels.x) | uint(pixels.y) << 16;
    bin_words[at + 3u] = uint(pixels.z) | uint(pixels.w) << 16;
    bin_words[at + 4u] = n;
}

void make_record(uint visible)
{
    uint copy = bin_words[crowd.copies.x + VISIBLE_WORDS * visible];
    uint n = bin_words[crowd.copies.x + VISIBLE_WORDS * visible + 4u];
    uvec4 axis = crowd.objects_of[n].axis;
    uvec4 numbers = crowd.objects_of[n].copies;
    dvec3 p = from_eye(copy);
    dvec4 q = dvec4(placed(copy, 3u), placed(copy, 4u), placed(copy, 5u), placed(copy, 6u));
    dvec3 s = dvec3(placed(copy, 7u), placed(copy, 8u), placed(copy, 9u));
    dvec3 middle = p + turned(q, s * dvec3(0.0lf, 0.0lf, 0.5lf));
    double depth = dot(middle, TRIPLE(crowd.forward));
    dvec3 to_plane = TRIPLE(crowd.dir_00) * max(depth, 0.0lf);
    dvec3 to_axis = dvec3(packDouble2x32(axis.xy), packDouble2x32(axis.zw), 0.0lf);
    dvec3 origin = turned(dvec4(-q.xyz, q.w), to_plane - p) / s - to_axis;
    Instance i;
    i.position_sx = vec4(vec3(p), float(s.x));
    i.rotation = vec4(q);
    i.scale_depth = vec4(float(s.y), float(s.z), float(depth), float(dot(TRIPLE(crowd.clip_x), middle)));
    i.origin = vec4(vec3(origin), float(dot(TRIPLE(crowd.clip_y), middle)));
    // The level of this copy, as by CopyLevels of src/plan/levels.rs.
    float largest = max(max(i.position_sx.w, i.scale_depth.x), i.scale_depth.y);
    precise vec4 limits = largest * crowd.objects_of[n].limits;
    uvec4 passes = uvec4(greaterThanEqual(i.scale_depth.zzzz, limits));
    uvec4 pieces = crowd.objects_of[n].pieces;
    uint coarser = max(passes.x + passes.y + passes.z + passes.w, pieces.w) - pieces.w;
    uint finest = objects[numbers.w].object.patches.x;
    uint table = coarser == 0u ? finest : objects[numbers.w].object.levels[coarser - 1u];
    i.object = uvec4(numbers.w, pieces.x, 0u, table);
    instances[numbers.z + copy - numbers.x] = i;
}

void main()
{
    uint n = invocation();
    if (pushed.bin == COPY_BOUNDS && n < crowd.counts.x) {
        find_bounds(n);
    } else if (pushed.bin == COPY_RECORDS && n < count_of(LISTED)) {
        make_record(bin_words[crowd.copies.z + n]);
    }
}
