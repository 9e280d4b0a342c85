// One ray against one solid: clip, search, close. The only tracer; both stages call it.
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

// Whether rays begin outside of the solid and the box cuts nothing of it. Those towards lights may begin anywhere.
#if SHADOWED
#define FROM_OUTSIDE (OUTSIDE != 0u && !casts)
#else
#define FROM_OUTSIDE (OUTSIDE != 0u)
#endif

// Whether the ray begins in the solid, as it does anyhow where it comes from within, `inside`; `f` is F there, of
// searches on the map.
bool begins_within(Meridian m, bool inside, inout uint steps, out float f)
{
    f = 0.0;
#if SEARCH == SEARCH_QUADRIC
    // Floor and ceiling are patches. Through the sides one enters the solid only where it reaches past them.
    float side_face = solid.bounds.x - max(abs(solid.axis.x), abs(solid.axis.y));
    bool open_side = m.face_in < FACE_Z && solid.bounds.y >= side_face;
    return inside || (m.from_eye || open_side) && starts_within(m);
#elif READS_TABLES
    return inside || starts_in_table(m);
#else
    f = field(point_rz(m, 0.0));
    ++steps;
    return inside || f <= 0.0;
#endif
}

// The first hit; `quadric`, of tables, is what was hit. `span`: between these s all that the ray may meet is.
uint search_any(Meridian m, float side, float f, vec2 span, inout float s, inout uint steps, out vec4 quadric)
{
    quadric = vec4(0.0);
#if SEARCH == SEARCH_QUADRIC
    return search_quadric(m, side, span, s, steps, quadric);
#elif READS_TABLES
    return search(m, side, s, steps, quadric);
#else
    return search(m, side, max(side * f, 0.0), pixel_width(m.base + m.t_start), s, steps);
#endif
}

// Several ways out, though clip_ray has one: measured, it is this here that lavapipe's code is shortest with.
//
// Look-ups are counted in `hit.steps` even when nothing is met. `inside`: the ray comes from a replica that is solid
// where it enters. `span`: the ray meets nothing before and behind these t.
bool trace_solid(vec3 eye, vec3 v, float base, vec2 span, bool inside, inout Hit hit)
{
    Meridian m;
    if (!clip_ray(eye, v, base, m)) {
        return false;
    }
    float s = 0.0;
    float f;
    bool within = false;
    if (!FROM_OUTSIDE) {
        within = begins_within(m, inside, hit.steps, f);
    }
    hit.at_border = false;
    if (within && !inside && m.face_in != FACE_NONE) {
        // The box cuts the solid, and the cut is closed.
        hit.t = m.t_start;
        hit.normal = face_normal(m.face_in, v, -1.0);
        hit.point = m.o;
        return true;
    }
    // From within the solid its boundary is seen from behind; unsigned distances know no inside.
    float side = within && (inside || m.from_eye) && RGBA8 == 0 ? -1.0 : 1.0;
    vec4 quadric;
    uint end = search_any(m, side, f, span - m.t_start, s, hit.steps, quadric);
#if REPEATED && SEARCH == SEARCH_QUADRIC
    // A floor or ceiling that lies in a border between cells is a patch, and is closed like the other borders.
    bool at_level = m.face_out == FACE_Z && s >= m.s_end - 1e-5 * m.inverse_speed;
    end = REPLICAS != 0u && side < 0.0 && end == FOUND && at_level ? LEFT : end;
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

#endif
