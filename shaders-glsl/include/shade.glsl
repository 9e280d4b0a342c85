// From a hit to what is stored of it. Blinn-Phong, linear light.
#ifndef SHADE_GLSL
#define SHADE_GLSL
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

vec3 blinn_phong(vec3 point, vec3 n, vec3 smooth_n, vec3 view, vec3 albedo)
{
    vec3 color = albedo * frame.ambient.rgb;
    for (uint i = 0u; i < LIGHTS; ++i) {
        vec3 l = frame.lights[i].towards.xyz;
        float lambert = dot(n, l);
        if (lambert > 0.0) {
            float highlight = pow(max(dot(n, normalize(l + view)), 0.0), solid.specular.y);
            vec3 light = frame.lights[i].color.rgb * (albedo * lambert + solid.specular.x * highlight);
            if (SHADOW != SHADOW_OFF) {
                light *= dot(smooth_n, l) > 0.0 ? light_reaching(point, l) : 0.0;
            }
            color += light;
        }
    }
    return color;
}

Shaded shade(Instance i, PixelRays rays, uvec2 pixel, Hit hit)
{
    Shaded s;
    vec3 dir = world_direction(pixel);
    float len = length(dir);
    vec3 view = dir / -len;
    s.distance = hit.t * len;
    s.normal = normal_to_world(i, hit.normal);

    // In the replica's own space: reflected and shrunk to its cell.
    vec3 count = vec3(solid.cells.xyz);
    vec3 n = CELLS == 0u ? hit.normal : normalize(hit.normal * hit.sense / count);
    Coordinates c = texture_coordinates(hit.point, n);
    s.uv = c.uv;
    s.albedo = solid.albedo.rgb;
    vec3 shaded = s.normal;
    if (COLOR_MAP != 0u || BUMP != BUMP_OFF) {
        vec3 v = ray_direction(rays, pixel);
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
            shaded = normal_to_world(i, CELLS == 0u ? tilted : tilted * hit.sense * count);
        }
    }
    // Seen from within, the surface's back is lit as a surface of its own.
    float facing = dot(s.normal, view) < 0.0 ? -1.0 : 1.0;
    s.shading_normal = facing * shaded;
    vec3 point = frame.eye.xyz + hit.t * dir;
    // A shadow's ray starts a texel off the surface, or it would meet the surface itself.
    float lift = 1.5 * solid.map.z * length(scale_of(i));
    s.color = vec4(blinn_phong(point + facing * lift * s.normal, s.shading_normal, facing * s.normal, view, s.albedo), 1.0);
    return s;
}

#endif
