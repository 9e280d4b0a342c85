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

// One root and one division, where `normalize` is a root and three: software drivers take it at its word.
vec3 unit(vec3 v)
{
    return v * inversesqrt(dot(v, v));
}

// Of one light, in the turned space.
vec3 blinn_phong(Look look, Light light, vec3 n, vec3 view, vec3 albedo)
{
    vec3 middle = light.towards.xyz + view;
    float aligned = dot(n, middle) * inversesqrt(max(dot(middle, middle), 1e-20));
    float highlight = pow(max(aligned, 0.0), look.scale_shininess.w);
    float facing = dot(n, light.towards.xyz);
    vec3 reflected = light.color.rgb * (albedo * facing + look.albedo_strength.w * highlight);
    return facing > 0.0 ? reflected : vec3(0.0);
}

Shaded shade(Instance i, Look look, PixelRays rays, uvec2 pixel, Hit hit)
{
    Shaded s;
    vec3 scale = look.scale_shininess.xyz;
    vec3 v = ray_direction(rays, pixel);
    vec3 dir = v * scale;
    float square = dot(dir, dir);
    float inverse_length = inversesqrt(square);
    vec3 view = dir * -inverse_length;
    // The normal over the scale, times the product of all three.
    vec3 turned = unit(hit.normal * (scale.yzx * scale.zxy));
    s.distance = hit.t * (square * inverse_length);
    s.normal = rotate(i.rotation, turned);

    // In the replica's own space: reflected and shrunk to its cell.
    vec3 count = vec3(solid.cells.xyz);
    vec3 n = unit(CELLS == 0u ? hit.normal : hit.normal * hit.sense / count);
    Coordinates c = texture_coordinates(hit.point, n);
    s.uv = c.uv;
    s.albedo = look.albedo_strength.rgb;
    vec3 shaded = turned;
    if (COLOR_MAP != 0u || BUMP != BUMP_OFF) {
        vec3 normal = unit(hit.normal);
        vec3 right = footprint(v, rays.dir_x, normal, hit.t);
        vec3 down = footprint(v, rays.dir_y, normal, hit.t);
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
        Light source;
        if (n < LOOK_LIGHTS) {
            source = look.lights[min(n, LOOK_LIGHTS - 1u)];
        } else {
            source = light_seen(i, n);
        }
        vec3 towards = source.towards.xyz;
        vec3 light = blinn_phong(look, source, lit, view, s.albedo);
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
