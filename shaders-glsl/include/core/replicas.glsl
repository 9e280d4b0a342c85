// Repetition: the box holds nx x ny x nz cells. Each contains a replica of the whole solid, scaled to the cell and
// clipped by it. The ray visits cells in order of distance and traces the single solid in each. A search is therefore
// as safe as without repetition, for any neighbours, mirrored or not.
#ifndef REPLICAS_GLSL
#define REPLICAS_GLSL
#include "core/trace.glsl"

// Returns -1 along axes in which a cell is reflected, else 1.
vec3 cell_sense(vec3 cell)
{
    vec3 odd = cell - 2.0 * floor(cell * 0.5);
    return 1.0 - 2.0 * vec3(uvec3(shape.flags) >> uvec3(0u, 1u, 2u) & 1u) * odd;
}

// Converts a lattice position to the cell's object space, including its reflection. The cell's middle maps to the
// box's.
vec3 in_cell(vec3 position, vec3 cell)
{
    vec3 size = vec3(2.0 * vec2(shape.half_side), 1.0);
    return ((position - cell - 0.5) * cell_sense(cell) + 0.5) * size - vec3(shape.axis + vec2(shape.half_side), 0.0);
}

// Returns true if the replica of a cell is solid at `p`, relative to its axis.
bool is_solid(vec3 p, inout uint steps)
{
#if READS_TABLES
    Meridian m;
    m.o = p;
    m.c = dot(p.xy, p.xy);
    return SOLID_AT(m);
#else
    ++steps;
    return field(vec2(length(p.xy), p.z)) <= 0.0;
#endif
}

bool trace_replicas(vec3 eye, vec3 v, float base, float start, vec2 span, inout Hit hit)
{
    // Lattice units: a cell has size 1 and the box's lower corner is at 0.
    vec3 count = vec3(shape.replicas);
    vec3 size = vec3(2.0 * vec2(shape.half_side), 1.0);
    vec3 o = (eye + vec3(shape.axis + vec2(shape.half_side), 0.0)) * count / size;
    vec3 d = v * count / size;
    vec3 inverse = 1.0 / mix(d, vec3(1e-30), equal(d, vec3(0.0)));
    vec3 t_low = -o * inverse;
    vec3 t_high = (count - o) * inverse;
    vec3 near = min(t_low, t_high);
    vec3 far = max(t_low, t_high);
    float t = max(max(near.x, near.y), max(near.z, start));
    float t_out = min(far.x, min(far.y, far.z));
    vec3 stride = vec3(greaterThanEqual(d, vec3(0.0)));
    vec3 cell = clamp(floor(o + t * d), vec3(0.0), count - 1.0);
    uint most = REPLICAS == 0u ? 1u : shape.replicas.x + shape.replicas.y + shape.replicas.z;
    bool inside = false; // the ray comes from a replica that is solid at the border
    for (uint i = 0u; i < most && (REPLICAS == 0u || t <= t_out); ++i) {
        vec3 local = eye;
        vec3 local_v = v;
        vec3 sense = vec3(1.0);
        if (REPLICAS != 0u) {
            sense = cell_sense(cell);
            local = in_cell(o, cell);
            local_v = d * sense * size;
        }
        bool met = trace_solid(local, local_v, base, start, REPLICAS == 0u ? span : EVERYWHERE, inside, hit);
        vec3 next = (cell + stride - o) * inverse;
        t = min(next.x, min(next.y, next.z));
        vec3 beyond = cell + mix(vec3(0.0), sign(d), equal(next, vec3(t)));
        bool last = REPLICAS == 0u || any(lessThan(beyond, vec3(0.0))) || any(greaterThanEqual(beyond, count));
        // The border between two replicas that are both solid there is invisible. Rounding must not select the cell
        // that the ray is leaving.
        vec3 border = clamp(o + t * d, beyond + 1e-5, beyond + (1.0 - 1e-5));
        inside = REPLICAS != 0u && met && hit.at_border && !last && is_solid(in_cell(border, beyond), hit.steps);
        if (met && !inside) {
            if (REPLICAS != 0u) {
                hit.sense = sense;
                hit.normal = normalize(hit.normal * sense * count);
            }
            return true;
        }
        if (last) {
            return false;
        }
        cell = beyond;
    }
    return false;
}

// Traces the ray `eye + t v`. The eye, or the point that is shaded, is at t = -base. Rays from the eye begin at the
// host's near plane, also where it is known to cut no solid: roots count from there, and their last bits must not depend on
// what else is drawn with a copy. The ray has no hit outside the range `span` of t.
bool trace(vec3 eye, vec3 v, float base, vec2 span, out Hit hit)
{
    hit = NO_HIT;
    float start = (casts() ? 0.0 : frame_block.ray_start) - base;
    return trace_replicas(eye, v, base, start, span, hit);
}

#endif
