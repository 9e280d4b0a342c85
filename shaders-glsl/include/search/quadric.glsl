// The quadric search. The solid's boundary is a set of patches of quadrics of revolution, sorted into rows of equal
// height. A 4-ary tree over the rows holds their ranges of r^2. Rays and patches are parabolas in (z, r^2). Rows are
// visited in order of t. src/surface/rows.rs defines the layout.
//
// The search is exact up to rounding. It has no step size, no threshold and no limit on steps.
#ifndef SEARCH_QUADRIC_GLSL
#define SEARCH_QUADRIC_GLSL
#include "core/surface.glsl"
#include "core/patch_tables.glsl"

// Returns the root at which the ray enters (G changes from positive to negative). NaN or out of range if there is none.
// `z`: height of m.o above the patch's anchor, which keeps the cancellation in `ga` small.
float entering_root(Meridian m, vec4 q, float z, float side)
{
    float al = side * (q.x * m.a + q.w * m.v.z * m.v.z);
    float be = side * (q.x * m.b + (0.5 * q.z + q.w * z) * m.v.z);
    float ga = side * (q.x * m.c + (q.y + z * (q.z + z * q.w)));
    float root = sqrt(be * be - al * ga);
    bool towards = be <= 0.0;
    return mix(-(be + root), ga, towards) / mix(al, root - be, towards);
}

float square_at(Meridian m, float s)
{
    return m.c + s * (2.0 * m.b + s * m.a);
}

const float HEIGHT_SLACK = 1e-3; // outside the box's height another sheet of a quadric may satisfy the guard

// Replaces the nearest hit so far by the hit with patch `q`, if that is after `least` and nearer. Returns true if the hit
// is not after `least`.
bool take_nearer(Meridian m, vec4 q, vec4 guard, float least, inout float best, inout vec4 quadric)
{
    float above = m.o.z - guard.x;
    float root = entering_root(m, q, above, 1.0);
    float z = m.o.z + root * m.v.z;
    float guarded = abs(q.x) * (above + root * m.v.z) + guard.y * square_at(m, root);
    bvec3 within = lessThanEqual(vec3(guard.z, guarded, abs(z - 0.5)), vec3(guarded, guard.w, 0.5 + HEIGHT_SLACK));
    bool nearer = all(within) && root > least && root < best;
    best = mix(best, root, nearer);
    quadric = mix(quadric, vec4(q.x, guard.x, q.zw), bvec4(nearer));
    return all(within) && root <= least;
}

// Returns true if the ray starts in the solid: the number of patches outward of the start is odd.
bool starts_within(Meridian m)
{
    uint row = uint(clamp(m.o.z, 0.0, 1.0) * float(PATCH_ROWS));
    uint run = patch_word(PATCH_NODES + min(row, PATCH_ROWS - 1u));
    uint beyond = 0u;
    for (uint n = 0u; n < (run & ((1u << RUN_BITS) - 1u)); ++n) {
        uint record = (run >> RUN_BITS) + n;
        uint at = FIRST_RECORD + 2u * record;
        vec4 q = patch_vector(at);
        float above = m.o.z - patch_vector(at + 1u).x;
        vec4 ranges = patch_vector(~(record >> 1));
        vec2 range = (record & 1u) == 0u ? ranges.xy : ranges.zw;
        float p = -q.x * (q.y + above * (q.z + above * q.w));
        beyond += uint(q.x != 0.0 && range.x <= m.o.z && m.o.z < range.y && p > m.c);
    }
    return (beyond & 1u) != 0u;
}

// Returns FOUND or LEFT; `hit_quadric` is that of the patch that was hit, as quadric_normal() reads it.
uint search_quadric(Meridian m, float side, inout float s, inout uint steps, out vec4 hit_quadric)
{
    const int rows = int(PATCH_ROWS);
    float n = float(rows);
    bool up = m.v.z >= 0.0;
    float per_z = 1.0 / (up ? max(m.v.z, 1e-20) : min(m.v.z, -1e-20));
    float nearest = -m.b / max(m.a, 1e-30);
    // The start has an error of a few roundings of the distance from the ray's origin. The slack keeps a box face that
    // is also the solid's own face from being missed.
    float slack = 4e-6 * m.inverse_speed + 4e-7 * abs(m.t_start);
    const int top = 3;
    int level = top;
    float t = 0.0;
    float last = m.s_end;
    int row = clamp(int(floor((m.o.z + t * m.v.z) * n)), 0, rows - 1);
    float most = square_at(m, t);
    float best = 3e38;
    uint hit_record = 0u;
    for (;;) {
        // Traverse the tree to the next row whose patches the ray may hit.
        uint run = 0u;
        int border;
        float leave;
        float most_out;
        for (;;) {
            int node = row >> (2 * level);
            border = (up ? node + 1 : node) << (2 * level);
            leave = max(min((float(border) / n - m.o.z) * per_z, last), t);
            most_out = square_at(m, leave);
            float least = square_at(m, clamp(nearest, t, leave));
            int base = level < 2 ? (level == 0 ? 0 : 256) : (level == 2 ? 320 : 336);
            vec2 extent = node_extent(patch_word(uint(base + node)));
            ++steps;
            bool meets = max(most, most_out) >= extent.x && least <= extent.y;
            if (meets && level == 0) {
                run = patch_word(PATCH_NODES + uint(row));
                break;
            }
            if (meets) {
                --level;
                continue;
            }
            row = up ? border : border - 1;
            if (leave >= last || row < 0 || row >= rows) {
                break;
            }
            t = leave;
            most = most_out;
            level = min(findLSB(border) >> 1, top);
        }
        // Roots count from the middle of the row, which is near the anchors of patches that end on the axis.
        // `square_at(near, x)` is `square_at(m, middle + x)`.
        float middle = clamp(((float(row) + 0.5) / n - m.o.z) * per_z, 0.0, m.s_end);
        Meridian near = m;
        near.o = m.o + middle * m.v;
        near.b = dot(near.o.xy, m.v.xy);
        near.c = dot(near.o.xy, near.o.xy);
        uint first = FIRST_RECORD + 2u * (run >> RUN_BITS);
        for (uint k = 0u; k < (run & ((1u << RUN_BITS) - 1u)); ++k) {
            uint at = first + 2u * k;
            vec4 q = patch_vector(at);
            vec4 guard = patch_vector(at + 1u);
            ++steps;
            float above = near.o.z - guard.x;
            float from_middle = entering_root(near, q, above, side);
            float guarded = abs(q.x) * (above + from_middle * m.v.z) + guard.y * square_at(near, from_middle);
            float root = middle + from_middle;
            bool within = all(lessThanEqual(vec4(guard.z, guarded, -slack, root), vec4(guarded, guard.w, root, m.s_end + slack)));
            bool nearer = within && root < best;
            best = mix(best, root, nearer);
            hit_record = nearer ? at : hit_record;
        }
        row = run == 0u ? row : (up ? border : border - 1);
        if (best <= leave || leave >= last || row < 0 || row >= rows) {
            break;
        }
        t = leave;
        most = most_out;
        level = min(findLSB(border) >> 1, top);
    }
    // Fetched again: fewer registers across the loop.
    vec4 hit = patch_vector(hit_record);
    hit_quadric = vec4(hit.x, patch_vector(hit_record + 1u).x, hit.zw);
    s = max(best, 0.0); // a hit at the eye must not be behind it
    return best < 2e38 ? FOUND : LEFT;
}

// Returns the outward normal in object space, not normalised. A tip on the axis has no normal; there it is -m.v.
// `q`: a patch's quadric with its anchor in place of the constant term, which the normal does not need.
vec3 quadric_normal(Meridian m, float s, vec4 q)
{
    vec3 p = m.o + s * m.v;
    vec3 n = vec3(2.0 * q.x * p.xy, q.z + 2.0 * q.w * (p.z - q.y));
    return dot(n, n) > 1e-30 ? n : -m.v;
}

#endif
