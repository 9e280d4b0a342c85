// From a hit to what is stored of it. Blinn-Phong, linear light.
#ifndef SHADE_GLSL
#define SHADE_GLSL
#include "look.glsl"
#include "texturing.glsl"
#include "shadow.glsl"

struct Shaded {
    vec4 color;          // linear RGBA
    vec3 normal;         // world, without bump
    vec3 shading_normal; // world, as shaded: bumped, and turned to the viewer
    vec3 albedo;
    vec2 uv;
    float distance; // along the ray, world units
};

// Of one light, in the turned space.
vec3 blinn_phong(Look look, vec3 towards, vec3 color, vec3 n, vec3 view, vec3 albedo)
{
    float highlight = pow(max(dot(n, normalize(towards + view)), 0.0), look.scale_shininess.w);
    vec3 light = color * (albedo * dot(n, towards) + look.albedo_strength.w * highlight);
    return dot(n, towards) > 0.0 ? light : vec3(0.0);
}

Shaded shade(Instance i, Look look, PixelRays rays, uvec2 pixel, Hit hit)
{
    Shaded s;
    vec3 scale = look.scale_shininess.xyz;
    vec3 v = ray_direction(rays, pixel);
    vec3 dir = v * scale;
    float len = length(dir);
    vec3 view = dir / -len;
    vec3 turned = normalize(hit.normal / scale);
    s.distance = hit.t * len;
    s.normal = rotate(i.rotation, turned);

    // In the replica's own space: reflected and shrunk to its cell.
    vec3 count = vec3(solid.cells.xyz);
    vec3 n = CELLS == 0u ? hit.normal : normalize(hit.normal * hit.sense / count);
    Coordinates c = texture_coordinates(hit.point, n);
    s.uv = c.uv;
    s.albedo = look.albedo_strength.rgb;
    vec3 shaded = turned;
    if (COLOR_MAP != 0u || BUMP != BUMP_OFF) {
        vec3 right = footprint(v, rays.dir_x, hit.normal, hit.t);
        vec3 down = footprint(v, rays.dir_y, hit.normal, hit.t);
        if (CELLS != 0u) {
            right *= hit.sense * count;
            down *= hit.sense * count;
        }
        if (COLOR_MAP != 0u) {
            s.albedo = sample_repeated(color_map, c, right, down).rgb;
        }
        if (BUMP != BUMP_OFF) {
            vec3 tilted = bumped(n, hit.point, c, right, down);
            shaded = normalize((CELLS == 0u ? tilted : tilted * hit.sense * count) / scale);
        }
    }
    // Seen from within, the surface's back is lit as a surface of its own.
    float facing = dot(turned, view) < 0.0 ? -1.0 : 1.0;
    vec3 lit = facing * shaded;
    s.shading_normal = rotate(i.rotation, lit);
    vec3 color = s.albedo * look.ambient;
    for (uint n = 0u; n < LIGHTS; ++n) {
        bool first = n == 0u;
        vec3 towards = first ? look.towards : rotate(conjugate(i.rotation), frame.lights[n].towards.xyz);
        vec3 light = blinn_phong(look, towards, first ? look.color : frame.lights[n].color.rgb, lit, view, s.albedo);
        if (SHADOW != SHADOW_OFF && light != vec3(0.0)) {
            // A shadow's ray starts a texel off the surface, or it would meet the surface itself.
            float lift = 1.5 * solid.map.z * length(scale);
            vec3 point = frame.eye.xyz + rotate(i.rotation, hit.t * dir + facing * lift * turned);
            light *= facing * dot(turned, towards) > 0.0 ? light_reaching(point, rotate(i.rotation, towards)) : 0.0;
        }
        color += light;
    }
    s.color = vec4(color, 1.0);
    return s;
}

#endif
