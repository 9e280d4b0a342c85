// One ray against one solid: clip, search, close. The only tracer; both stages call it.
#ifndef TRACE_GLSL
#define TRACE_GLSL
#include "search_circle.glsl"
#include "search_linear.glsl"
#include "search_live.glsl"
#include "search_quadric.glsl"
#include "search_relaxed.glsl"

struct Hit {
    float t;
    vec3 normal; // object space, outward, of any length
    vec3 point;  // object units about the axis of the replica that was hit
    vec3 sense;  // -1 where that replica is reflected
    uint steps;  // look-ups of the search
    bool exhausted; // the search ran out of steps
};

// Searches of tables made from the boundary itself; the others read the map.
const bool CONES = SOLVER == SOLVER_CONE || SOLVER == SOLVER_RELAXED;
const bool TABLES = SOLVER == SOLVER_QUADRIC || CONES;

// `pixel` is the width of a pixel in t: what the search need not tell apart.
uint search(Meridian m, float side, float f, float pixel, inout float s, inout uint steps)
{
    if (SOLVER == SOLVER_LIVE) {
        return search_live(m, side, f, pixel, s, steps);
    }
    if (SOLVER == SOLVER_CIRCLE) {
        return search_circle(m, side, f, s, steps);
    }
    return search_linear(m, side, f, s, steps);
}

// Of a ray that is known to begin outside of the solid, none of which the box cuts: pieces alone, between two t.
bool trace_between(vec3 eye, vec3 v, vec2 span, out Hit hit)
{
    float t_in = span.x;
    float t_out = span.y;
    // Above the ceiling and below the floor another sheet of a quadric may pass the guard.
    float per_z = 1.0 / (abs(v.z) > 1e-20 ? v.z : 1e-20);
    float low = (solid.bounds.z - eye.z) * per_z;
    float high = (solid.bounds.w - eye.z) * per_z;
    t_in = max(t_in, min(low, high));
    t_out = min(t_out, max(low, high));
    Meridian m;
    m.v = v;
    m.o = eye + t_in * v;
    m.a = dot(v.xy, v.xy);
    m.b = dot(m.o.xy, v.xy);
    m.c = dot(m.o.xy, m.o.xy);
    m.inverse_speed = inversesqrt(dot(v, v));
    m.t_start = t_in;
    m.s_end = t_out - t_in;
    float s = 0.0;
    vec4 quadric;
    hit.steps = 0u;
    uint end = search_quadric(m, 1.0, s, hit.steps, quadric);
    hit.t = t_in + s;
    hit.normal = quadric_normal(m, s, quadric);
    hit.point = m.o + s * v;
    hit.sense = vec3(1.0);
    hit.exhausted = false;
    return end == FOUND;
}

// Look-ups are counted in `hit.steps` even when nothing is met. `span`: two t, before and after which nothing of the solid is.
bool trace_solid(vec3 eye, vec3 v, vec2 span, inout Hit hit)
{
    Meridian m;
    if (!clip_ray(eye, v, m)) {
        return false;
    }
    if (AHEAD != 0u && !narrow(m, span)) {
        return false;
    }
    float s = 0.0;
    float f = 0.0;
    bool within;
    if (TABLES) {
        // Floor and ceiling are pieces. Through the sides one enters the solid only where it reaches past them.
        float side_face = solid.bounds.x - max(abs(solid.axis.x), abs(solid.axis.y));
        bool open_side = m.face_in < FACE_Z && solid.bounds.y >= side_face;
        if (CONES) {
            within = starts_within_cones(m);
        } else {
            within = (m.from_eye || open_side) && starts_within(m);
        }
    } else {
        f = field(point_rz(m, 0.0));
        ++hit.steps;
        within = f <= 0.0;
    }
    if (within && m.face_in != FACE_NONE) {
        // The box cuts the solid, and the cut is closed.
        hit.t = m.t_start;
        hit.normal = face_normal(m.face_in, v, -1.0);
        hit.point = m.o;
        return true;
    }
    // From within the solid its boundary is seen from behind; unsigned distances know no inside.
    bool unsigned_map = !TABLES && MAP_FORMAT == FORMAT_RGBA8;
    float side = within && m.from_eye && !unsigned_map ? -1.0 : 1.0;
    vec4 quadric;
    uint end;
    if (SOLVER == SOLVER_QUADRIC) {
        end = search_quadric(m, side, s, hit.steps, quadric);
    } else if (SOLVER == SOLVER_RELAXED && side > 0.0) {
        end = search_relaxed(m, s, hit.steps, quadric);
    } else if (CONES) { // of which none is in the solid: from there rows alone
        end = search_cone(m, side, s, hit.steps, quadric);
    } else {
        end = search(m, side, max(side * f, 0.0), frame.dir_00.w * m.t_start, s, hit.steps);
    }
    if (end == LEFT && side < 0.0 && m.face_out != FACE_NONE) {
        hit.t = m.t_start + m.s_end;
        hit.normal = face_normal(m.face_out, v, 1.0);
        hit.point = m.o + m.s_end * v;
        return true;
    }
    hit.exhausted = hit.exhausted || end >= EXHAUSTED;
    if (end != FOUND && end != NEARLY) {
        return false;
    }
    hit.t = m.t_start + s;
    hit.normal = TABLES ? quadric_normal(m, s, quadric) : surface_normal(m, s, side);
    hit.point = m.o + s * v;
    return true;
}

#endif
