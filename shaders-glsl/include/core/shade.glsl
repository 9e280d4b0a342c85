// Shading of a hit: Blinn-Phong in linear light.
#ifndef SHADE_GLSL
#define SHADE_GLSL
#include "core/hit.glsl"
#include "core/look.glsl"
#include "core/pixel_ray.glsl"
#include "core/texturing.glsl"
#include "core/shadow.glsl"

struct Shaded {
    vec4 color;          // linear RGBA
    vec3 normal;         // world, without bump
    vec3 shading_normal; // world, used for shading: bumped and facing the viewer
    vec3 albedo;
    vec2 uv;
    float distance; // along the ray, world units
};

// Normalises with one root and one division. Software drivers compile `normalize` to one root and three divisions.
vec3 unit(vec3 v)
{
    return v * inversesqrt(dot(v, v));
}

// Returns the changes of the surface point a ray's width to the right and down, profile units. A replica's are in its own
// space.
void footprints(PixelRays rays, vec3 v, Hit hit, out vec3 right, out vec3 down)
{
    vec3 normal = unit(hit.normal);
    float t = rays.base + hit.t; // relative to the eye
    float units = profile_units() * frame_block.ray_width;
    right = footprint(v, rays.dir_x, normal, t) * units;
    down = footprint(v, rays.dir_y, normal, t) * units;
    if (REPLICAS != 0u) {
        right *= hit.sense * vec3(shape.replicas);
        down *= hit.sense * vec3(shape.replicas);
    }
}

#include "core/host_shading.glsl"

// Returns the light reflected from one light. All directions have the same axes.
vec3 blinn_phong(Look look, Light light, vec3 n, vec3 view, vec3 albedo)
{
    vec3 middle = light.towards + view;
    float aligned = dot(n, middle) * inversesqrt(max(dot(middle, middle), 1e-20));
    float highlight = pow(max(aligned, 0.0), look.scale_shininess.w);
    float facing = dot(n, light.towards);
    vec3 reflected = light.color * (albedo * facing + look.albedo_strength.w * highlight);
    return facing > 0.0 ? reflected : vec3(0.0);
}

#ifndef HOST_SHADING
// Returns the colour of the environment in a direction of this height, the component along z of a unit vector.
vec3 sky(float height)
{
    return mix(frame_block.sky_down.rgb, frame_block.sky_up.rgb, 0.5 + 0.5 * height);
}

// Returns the light reflected from the part of a light's disc that a point sees: the mean over its rays. World axes.
// `point`: relative to the instance; `outward`: normal without bumps, below whose horizon the surface hides the disc.
vec3 shadowed(Look look, Light light, vec3 n, vec3 outward, vec3 view, vec3 albedo, vec3 point, uvec2 pixel)
{
    Disc disc = disc_of(light.towards, light.cap, pixel);
    uint open = 0u;
    vec2 angle = disc.first;
    for (uint k = SPIRAL_BEGIN; k < SPIRAL_END; ++k) {
        vec3 towards = towards_disc(disc, k, angle);
        open |= min(dot(outward, towards), dot(n, towards)) > 0.0 ? 1u << k % LIGHT_RAYS : 0u;
        angle = next_angle(angle);
    }
    vec3 sum = vec3(0.0);
    if (open != 0u) {
        uint lit = reaching(look.position, point, disc, open);
        angle = disc.first;
        for (uint k = SPIRAL_BEGIN; k < SPIRAL_END; ++k) {
            light.towards = towards_disc(disc, k, angle);
            sum += (lit >> k % LIGHT_RAYS & 1u) != 0u ? blinn_phong(look, light, n, view, albedo) : vec3(0.0);
            angle = next_angle(angle);
        }
    }
    return sum / float(LIGHT_RAYS);
}
#endif

Shaded shade(Look look, PixelRays rays, vec2 pixel, Hit hit)
{
    Shaded s;
    vec3 scale = look.scale_shininess.xyz;
    vec3 v = ray_direction(rays, pixel);
    vec3 dir = v * scale;
    float speed = length(dir);
    vec3 view = dir / -speed;
    // The normal divided by the scale, times the product of the three scales.
    vec3 turned = unit(hit.normal * (scale.yzx * scale.zxy));
    float t = rays.base + hit.t; // relative to the eye
    s.distance = t * speed;
    s.normal = rotate(look.rotation, turned);
    s.albedo = look.albedo_strength.rgb;
    s.uv = vec2(0.0);
    vec3 shaded = turned;
    // Normal in the replica's own space, which is reflected and scaled to its cell.
    vec3 count = vec3(shape.replicas);
    vec3 n = unit(REPLICAS == 0u ? hit.normal : hit.normal * hit.sense / count);
    Coordinates c = texture_coordinates(hit.point, n);
    s.uv = c.uv;
    if (COLOR_MAP != 0u || BUMP != BUMP_OFF) {
        vec3 right, down;
        footprints(rays, v, hit, right, down);
        if (COLOR_MAP != 0u) {
            s.albedo = sample_repeated(color_map, c, right, down).rgb;
        }
        if (BUMP != BUMP_OFF) {
            vec3 tilted = bumped(n, hit.point, c, right, down);
            tilted = normalize((REPLICAS == 0u ? tilted : tilted * hit.sense * count) / scale);
            shaded = appearance.bump == 0.0 ? turned : tilted;
        }
    }
    // The back of a surface, seen from within, is lit like a front. Products with a sign would be rounded differently by
    // different pipelines.
    bool is_back = dot(turned, view) < 0.0;
    vec3 lit = is_back ? -shaded : shaded;
    vec3 outward = is_back ? -turned : turned;
    s.shading_normal = rotate(look.rotation, lit);
#ifdef HOST_SHADING
    s.color = host_shade(surface_of(look, rays, pixel, hit, s, c));
    return s;
#else
    vec3 color = s.albedo * look.ambient;
    // A shadow ray starts off the surface, so that it cannot hit the surface itself. The offset is a few roundings for
    // exact patches and 1.5 texels for a map. Offsets are object space lengths, which a scale does not change equally
    // along all axes.
    float off = SEARCH == SEARCH_QUADRIC ? 5e-5 : 1.5 * shape.texel;
    float lift = off * length(hit.normal) * inversesqrt(max(dot(hit.normal / scale, hit.normal / scale), 1e-30));
    vec3 from_axis = ray_origin(rays, pixel) + vec3(shape.axis, 0.0) + hit.t * v;
    vec3 point = rotate(look.rotation, from_axis * scale + lift * outward); // relative to the instance, world axes
    // The first two lights are unrolled: a loop costs software drivers a sixth of a frame or more, even with no
    // iterations. Shadow code is so long that all lights share one loop.
    if (SHADOW == SHADOW_OFF) {
        color += blinn_phong(look, look.light_0, lit, view, s.albedo);
        if (LIGHTS > 1u) {
            color += blinn_phong(look, look.light_1, lit, view, s.albedo);
        }
    }
    if (SHADOW != SHADOW_OFF || LIGHTS > 2u) {
        for (uint n = SHADOW == SHADOW_OFF ? 2u : 0u; n < frame.light_count; ++n) {
            Light light = frame_block.lights[n];
            if (SHADOW == SHADOW_OFF) {
                color += blinn_phong(look, turned_to(look.rotation, light), lit, view, s.albedo);
            } else {
                vec3 above = rotate(look.rotation, outward), to_eye = rotate(look.rotation, view);
                color += shadowed(look, light, s.shading_normal, above, to_eye, s.albedo, point, uvec2(pixel + 0.5));
            }
        }
    }
    if (ENVIRONMENT != 0u) {
        vec2 material = unpackUnorm2x16(appearance.material);
        float height = s.shading_normal.z, facing = dot(lit, view);
        float reflected = 2.0 * facing * height - rotate(look.rotation, view).z;
        float glass = mix(0.04, 1.0, pow(1.0 - clamp(facing, 0.0, 1.0), 5.0));
        vec3 highlight = look.albedo_strength.w * mix(vec3(glass), s.albedo, material.y);
        color += s.albedo * sky(height) + highlight * sky(mix(reflected, height, material.x));
    }
    s.color = vec4(color, 1.0);
    return s;
#endif
}

#endif
