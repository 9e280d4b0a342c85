// How much of a light reaches a point: a ray towards it, traced against every solid of the scene.
#ifndef SHADOW_GLSL
#define SHADOW_GLSL
#if SHADOWED
#include "core/pixel_ray.glsl"
#include "core/replicas.glsl"

layout(set = 0, binding = 3, std140) uniform ShadowBlock {
    uvec4 shadow_batches; // their number
    Solid shadow_solids[MAX_SHADOW_BATCHES];
};

// A soft shadow is cheap: from how close the ray passes a surface, in units of how far along it does (Inigo Quilez'
// estimate of sphere tracers), about a light of half this angle's tangent.
const float PENUMBRA = 0.06;

// Nearness of the ray to the solid, F / distance along the ray, by the clipped ray's own few look-ups.
float solid_openness(vec3 eye, vec3 v)
{
    Meridian m;
    if (!clip_ray(eye, v, 0.0, m)) {
        return 1.0;
    }
    float open = 1.0;
    float s = 0.0;
    for (uint i = 0u; i < 48u && s < m.s_end; ++i) {
        float f = field(point_rz(m, s));
        float along = (m.t_start + s) / m.inverse_speed;
        open = min(open, f / max(PENUMBRA * along, 1e-4));
        if (open <= 0.0) {
            return 0.0;
        }
        s += max(f, 0.5 * solid.map.z) * m.inverse_speed;
    }
    return open;
}

// `point` is given from `place`, that from the eye; world axes.
float light_reaching(vec3 place, vec3 point, vec3 towards)
{
    float open = 1.0;
    Solid own = solid;
    casts = true;
    for (uint b = 0u; b < shadow_batches.x && open > 0.0; ++b) {
        solid = shadow_solids[b];
        shadow_map = int(solid.instances.z);
        for (uint n = 0u; n < solid.instances.y && open > 0.0; ++n) {
            Instance i = instances[solid.instances.x + n];
            vec3 eye = point_to_axis(i, place, point);
            vec3 v = direction_to_object(i, towards);
            if (SHADOW == SHADOW_SOFT && solid.cells.x * solid.cells.y * solid.cells.z == 1u) {
                open = min(open, solid_openness(eye, v));
            } else {
                Hit hit;
                open = trace(eye, v, 0.0, EVERYWHERE, hit) ? 0.0 : open;
            }
        }
    }
    solid = own;
    casts = false;
    return clamp(open, 0.0, 1.0);
}

#endif
#endif
