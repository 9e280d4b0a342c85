// Traces one ray against one solid or its replicas: clip, search, close. Searches by the tree, by the map and of other
// crates trace here, in both stages. Cells, listed tiles and culled tiles solve patches by take_nearer() of
// search/quadric.glsl.
#ifndef TRACE_GLSL
#define TRACE_GLSL
#include "core/hit.glsl"
#include "core/pixel_ray.glsl"
#if SEARCH == SEARCH_LIVE
#include "search/live.glsl"
#elif SEARCH == SEARCH_QUADRIC
#include "search/quadric.glsl"
#elif SEARCH == SEARCH_EXTERNAL
#include "search/external.glsl"
#endif

// Returns true if a point is in the solid; reads only m.o and m.c.
#if SEARCH == SEARCH_QUADRIC
#define SOLID_AT starts_within
#elif READS_TABLES
#define SOLID_AT starts_in_table
#endif

// Returns true if the ray begins in the solid. `inside`: the ray comes from within and always does. `f`: F at the
// start, for searches on the map.
bool begins_within(Meridian m, bool inside, inout RayStart start, inout uint steps, out float f)
{
    f = 0.0;
#if SEARCH == SEARCH_QUADRIC
    // Floor and ceiling are patches. A ray can enter the solid through a side only where the solid extends past it.
    float side_face = shape.half_side - max(abs(shape.axis.x), abs(shape.axis.y));
    bool open_side = m.face_in < FACE_Z && shape.clip_radius >= side_face;
    bool within = inside || (start.is_known && m.from_eye ? start.is_within : (m.from_eye || open_side) && SOLID_AT(m));
    // If the point is outside of the cylinder, nothing is solid where rays enter it.
    start.is_known = start.to_light && m.from_eye;
    start.is_within = within;
    return within;
#elif READS_TABLES
    return inside || SOLID_AT(m);
#else
    f = field(point_rz(m, 0.0));
    ++steps;
    return inside || f <= 0.0;
#endif
}

// Traces the solid. Unlike clip_ray it has several returns: measurements show the shortest lavapipe code for this form.
//
// `hit.steps` counts look-ups even without a hit. `first`: least t; `inside`: the ray comes from a replica that is solid
// where the ray enters.
bool trace_solid(vec3 eye, vec3 v, float base, float first, bool inside, inout RayStart start, inout Hit hit)
{
    Meridian m;
    if (!clip_ray(eye, v, base, first, m)) {
        return false;
    }
    m.to_light = start.to_light;
    float s = 0.0;
    float f;
    bool within = false;
    // Rays towards lights may begin anywhere.
    if (!is_outside() || start.to_light) {
        within = begins_within(m, inside, start, hit.steps, f);
    }
    hit.at_border = false;
    if (within && !inside && m.face_in != FACE_NONE) {
        // The box cuts the solid, and the cut is closed by a face.
        hit.t = m.t_start;
        hit.normal = face_normal(m.face_in, v, -1.0);
        hit.point = m.o;
        return true;
    }
    // A ray within the solid hits the back of its boundary. Unsigned distances cannot distinguish inside from outside.
    float side = within && (inside || m.from_eye) && RGBA8 == 0u ? -1.0 : 1.0;
#if READS_TABLES
    vec4 quadric; // of the patch that is hit
#endif
#if SEARCH == SEARCH_QUADRIC
    uint end = search_quadric(m, side, s, hit.steps, quadric);
    // A floor or ceiling at a border between cells is a patch, and is closed like the other borders.
    bool at_level = m.face_out == FACE_Z && s >= m.s_end - 1e-5 * m.inverse_speed;
    end = REPLICAS != 0u && side < 0.0 && end == FOUND && at_level ? LEFT : end;
#elif READS_TABLES
    uint end = search(m, side, s, hit.steps, quadric);
#else
    uint end = search(m, side, max(side * f, 0.0), pixel_width(m.base + m.t_start), s, hit.steps);
#endif
    if (end == LEFT && side < 0.0 && m.face_out != FACE_NONE) {
        hit.t = m.t_start + m.s_end;
        hit.at_border = true;
        hit.normal = face_normal(m.face_out, v, 1.0);
        hit.point = m.o + m.s_end * v;
        return true;
    }
    hit.exhausted = hit.exhausted || end >= EXHAUSTED;
    if (end != FOUND && end != NEARLY) {
        return false;
    }
    hit.t = m.t_start + s;
#if READS_TABLES
    hit.normal = quadric_normal(m, s, quadric);
#else
    hit.normal = surface_normal(m, s, side);
#endif
    hit.point = m.o + s * v;
    return true;
}

// Repetition: the box holds nx x ny x nz cells. Each contains a replica of the whole solid, scaled to the cell and
// clipped by it. The ray visits cells in order of distance and traces the single solid in each. A search is therefore
// as safe as without repetition, for any neighbours, mirrored or not.

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

// Traces the ray `eye + t v`. The eye, or the point that is shaded, is at t = -base. Rays from the eye begin at the
// host's near plane, also where it is known to cut no solid: roots count from there, and their last bits must not
// depend on what else is drawn with a copy.
bool trace(vec3 eye, vec3 v, float base, inout RayStart start, out Hit hit)
{
    hit = NO_HIT;
    float first = (start.to_light ? 0.0 : frame_block.ray_start) - base;
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
    float t = max(max(near.x, near.y), max(near.z, first));
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
        // What is known of a start holds for one solid, not for the replicas beside it.
        RayStart own = RayStart(start.to_light, REPLICAS == 0u && start.is_known, start.is_within);
        bool met = trace_solid(local, local_v, base, first, inside, own, hit);
        if (REPLICAS == 0u) {
            start = own;
        }
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

#endif
