// A **beam** bounds the rays of a square of pixels: the middle ray and the largest deviation from it.
#ifndef BEAM_GLSL
#define BEAM_GLSL
#include "core/meridian.glsl"
#include "core/patch_tables.glsl"
#include "core/pixel_ray.glsl"

struct Beam {
    vec3 o;
    vec3 v;
    float least, nearest, a, b; // r^2 of the middle ray: least + a (t - nearest)^2
    float per_z; // 1 / v.z
    vec2 spread; // largest deviation of a direction from the middle one: across the axis, along it
    vec2 width; // largest distance of a ray from the middle one at equal t, anywhere in the box: across the axis, along it
    float base;
    float unit; // unit of the radii of patches
};

// Returns the depth of the far side of the box.
float farthest_of(PixelRays rays, Instance i)
{
    vec3 half_size = vec3(shape.half_side, shape.half_side, 0.5);
    vec3 forward = rotate(conjugate(i.rotation), frame.forward) * i.scale;
    return rays.base + dot(abs(forward), half_size);
}

// Returns the beam of a square of pixels.
Beam beam_of(PixelRays rays, uvec2 corner, uint side, float farthest, float unit)
{
    Beam beam;
    float half_side = 0.5 * float(side);
    vec2 middle = vec2(corner) + half_side - 0.5;
    beam.v = rays.dir_00 + middle.x * rays.dir_x + middle.y * rays.dir_y;
    beam.o = rays.origin + rays.base * (middle.x * rays.dir_x + middle.y * rays.dir_y);
    vec3 across = rays.dir_x + rays.dir_y, down = rays.dir_x - rays.dir_y; // the square's diagonals
    beam.spread = half_side * vec2(max(length(across.xy), length(down.xy)), max(abs(across.z), abs(down.z)));
    beam.width = beam.spread * farthest + 1e-4 + 4e-7 * abs(vec2(length(beam.o.xy), beam.o.z));
    beam.a = max(dot(beam.v.xy, beam.v.xy), 1e-12 * dot(beam.v, beam.v));
    beam.b = dot(beam.o.xy, beam.v.xy);
    // This divides: rounding of 1 / a loses pixels of a plate that is a thousand times as wide as
    // high.
    beam.nearest = -beam.b / beam.a;
    beam.least = max(dot(beam.o.xy, beam.o.xy) - beam.a * beam.nearest * beam.nearest, 0.0);
    beam.per_z = 1.0 / (abs(beam.v.z) > 1e-20 ? beam.v.z : 1e-20);
    beam.base = rays.base;
    beam.unit = unit;
    return beam;
}

// Returns true if a ray of the beam may enter the solid through patch `k`, and the range of t in `span`.
bool may_meet(Beam beam, uint k, out vec2 span)
{
    uvec4 words = listed_table(3u + 3u * k);
    vec2 z = vec2(words.x & 0x7fffu, words.x >> 15 & 0x7fffu) / 32767.0;
    vec2 r = vec2(words.y & 0xffffu, words.y >> 16) * beam.unit;
    float k1 = uintBitsToFloat(words.z);
    float k2 = uintBitsToFloat(words.w);
    float sense = float(int(words.x >> 30)) - 1.0;
    float low = (z.x - beam.width.y - beam.o.z) * beam.per_z;
    float high = (z.y + beam.width.y - beam.o.z) * beam.per_z;
    float inner = max(r.x - beam.width.x, 0.0);
    float outer = r.y + beam.width.x;
    float reach = sqrt(max(outer * outer - beam.least, 0.0) / beam.a);
    float clear = sqrt(max(inner * inner - beam.least, 0.0) / beam.a);
    float slack = 4e-7 * (abs(beam.nearest) + reach);
    float enter = max(min(low, high), -beam.base);
    float leave = max(low, high);
    // Ranges of t within the ring, before and after the point nearest to the axis.
    vec2 before = vec2(max(enter, beam.nearest - reach - slack), min(leave, beam.nearest - clear + slack));
    vec2 behind = vec2(max(enter, beam.nearest + clear - slack), min(leave, beam.nearest + reach + slack));

    // Half of dG/dt along the middle ray is linear in t. The patch faces away where no ray's value is negative.
    float slope = 0.5 * k1 + k2 * beam.o.z;
    float al = sense * beam.a + k2 * beam.v.z * beam.v.z;
    float be = sense * beam.b + slope * beam.v.z;
    float steep = 0.5 * abs(k1) + abs(k2); // upper bound of |k1 / 2 + k2 z| for z in [0, 1]
    float turned = (r.y + beam.width.x) * beam.spread.x + beam.width.x * sqrt(beam.a);
    float tilted = (steep + abs(k2) * beam.width.y) * beam.spread.y + abs(k2) * beam.width.y * abs(beam.v.z);
    float most = abs(sense) * turned + tilted;
    bool faces_before = min(al * before.x, al * before.y) + be <= most;
    bool faces_behind = min(al * behind.x, al * behind.y) + be <= most;
    bool meets_before = before.x <= before.y && faces_before;
    bool meets_behind = behind.x <= behind.y && faces_behind;
    span = vec2(meets_before ? before.x : behind.x, meets_behind ? behind.y : before.y);
    return outer * outer > beam.least && (meets_before || meets_behind);
}

// Returns ranges of t between the box's sides: `outer` of any ray of a beam, `inner` of all its rays. Where a ray enters
// the solid before `inner`, the box may cut it: it may be inside the solid where it enters the box.
void cut_by_box(Beam beam, out vec2 outer, out vec2 inner)
{
    outer = inner = vec2(-1e30, 1e30);
    if (is_outside()) {
        return;
    }
    vec4 wider = beam.width.x * vec4(-1.0, -1.0, 1.0, 1.0);
    outer = between_sides(beam.o, beam.v, sides_of_box() + wider);
    inner = between_sides(beam.o, beam.v, sides_of_box() - wider);
    // Without a ray that is sure to be between the sides, any ray may be cut.
    inner.x = inner.x <= inner.y && beam.width.x < shape.half_side ? inner.x : 1e30;
}

// Returns the height at which s = 0 for the middle ray of a beam in a list of patches (search/listed.glsl).
float height_of_start(Beam beam)
{
    return beam.o.z + nearest_to(beam.o, beam.v, 0.5, weights_of_middle()) * beam.v.z;
}

// Returns the height of the anchor of patch `k`: of a cone, its tip.
float anchor_of(uint k)
{
    return uintBitsToFloat(listed_word(2u + 3u * k, 0u));
}

// Returns q of a cone r^2 = q h^2, h the height above its tip; of other patches at most that of their asymptotes.
float steepness_of(uint k)
{
    uvec4 words = listed_table(3u + 3u * k);
    return -uintBitsToFloat(words.w) * (float(int(words.x >> 30)) - 1.0);
}

// Returns true if rounding may move the hits of a beam's rays on patch `k` by more than half of the tolerance of
// patches. `start`: height of s = 0; `rounding`: the last factors below over half of the tolerance.
//
// Derivation for a cone r^2 = q h^2. The start s = 0 is at height h above the anchor, where the terms of be^2 - al ga
// have the size q^2 h^2. Eight roundings of them are the error. A hit at radius r has the term q r^2. Half of the ratio,
// times r / sqrt(q), is the error in height: sqrt(q) h^2 / r * 4 * 2^-24.
bool is_imprecise(Beam beam, uint k, float start, float rounding)
{
    float height = start - anchor_of(k);
    float least = float(listed_table(3u + 3u * k).y & 0xffffu) * beam.unit;
    float radius = max(least, sqrt(beam.least) - beam.width.x);
    float error = rounding * height * height;
    return error * error * steepness_of(k) > radius * radius;
}

// Returns true if all rays of a beam are at least half as steep as cone `k`.
//
// Such rays may begin at the height of the tip. All terms of be^2 - al ga are then multiples of c, the square of the
// ray's distance from the tip there, and at most 5 times q v.z^2 c. Eight roundings move a hit by at most
// 20 * 2^-24 of its height above the tip, less than half of the tolerance of patches.
bool is_steeper(Beam beam, uint k)
{
    float along = max(abs(beam.v.z) - beam.spread.y, 0.0);
    float across = sqrt(beam.a) + beam.spread.x;
    return 4.0 * steepness_of(k) * along * along >= across * across;
}

#endif
