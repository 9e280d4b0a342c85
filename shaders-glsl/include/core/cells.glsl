// Repetition: the box holds nx x ny x nz cells, each a replica of the whole solid, shrunk to its cell and cut by it. The ray is
// taken from cell to cell in the order in which it meets them, and in each the one solid is traced: as safe as that, next to
// any neighbour, mirrored or not.
#ifndef CELLS_GLSL
#define CELLS_GLSL
#include "core/trace.glsl"

#if REPEATED
bool trace_cells(vec3 eye, vec3 v, vec2 span, inout Hit hit)
{
    // In units in which a cell is as large as the box is without repetition; its lower corner at 0.
    vec3 count = vec3(solid.cells.xyz);
    vec3 size = vec3(2.0 * solid.bounds.xx, 1.0);
    vec3 o = (eye + vec3(solid.axis.xy + solid.bounds.xx, 0.0)) * count / size;
    vec3 d = v * count / size;
    vec3 inverse = 1.0 / mix(d, vec3(1e-30), equal(d, vec3(0.0)));
    vec3 t_low = -o * inverse;
    vec3 t_high = (count - o) * inverse;
    vec3 near = min(t_low, t_high);
    vec3 far = max(t_low, t_high);
    float t = max(max(near.x, near.y), max(near.z, 0.0));
    float t_out = min(far.x, min(far.y, far.z));
    vec3 stride = vec3(greaterThanEqual(d, vec3(0.0)));
    vec3 cell = clamp(floor(o + t * d), vec3(0.0), count - 1.0);
    uint most = CELLS == 0u ? 1u : solid.cells.x + solid.cells.y + solid.cells.z;
    for (uint i = 0u; i < most && (CELLS == 0u || t <= t_out); ++i) {
        vec3 local = eye;
        vec3 local_v = v;
        vec3 sense = vec3(1.0);
        if (CELLS != 0u) {
            vec3 odd = cell - 2.0 * floor(cell * 0.5);
            vec3 mirrored = vec3(uvec3(solid.cells.w) >> uvec3(0u, 1u, 2u) & 1u) * odd;
            sense = 1.0 - 2.0 * mirrored;
            // Into the cell's own object space: its middle to the box's middle, reflected where it is mirrored.
            local = ((o - cell - 0.5) * sense + 0.5) * size - vec3(solid.axis.xy + solid.bounds.xx, 0.0);
            local_v = d * sense * size;
            span = EVERYWHERE;
        }
        if (trace_solid(local, local_v, span, hit)) {
            if (CELLS != 0u) {
                hit.sense = sense;
                hit.normal = normalize(hit.normal * sense * count);
            }
            return true;
        }
        vec3 next = (cell + stride - o) * inverse;
        t = min(next.x, min(next.y, next.z));
        cell += mix(vec3(0.0), sign(d), equal(next, vec3(t)));
        if (any(lessThan(cell, vec3(0.0))) || any(greaterThanEqual(cell, count))) {
            return false;
        }
    }
    return false;
}
#endif

bool trace(vec3 eye, vec3 v, vec2 span, out Hit hit)
{
    hit.steps = 0u;
    hit.exhausted = false;
    hit.sense = vec3(1.0);
#if REPEATED
    return trace_cells(eye, v, span, hit);
#else
    return trace_solid(eye, v, span, hit);
#endif
}

#endif
