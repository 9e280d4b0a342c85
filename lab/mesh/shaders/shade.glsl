// From a pixel of a mesh to what is stored of it. Blinn-Phong in linear light, as the renderer does.
#ifndef SHADE_GLSL
#define SHADE_GLSL
#include "mesh.glsl"
#ifdef SHADOWS
#include "shadow.glsl"
#else
const float PI = 3.14159265358979;
#endif

struct Shaded {
    vec4 color;          // linear RGBA
    vec3 normal;         // world
    vec3 shading_normal; // world, turned to the viewer
    vec3 albedo;
    vec2 uv;
    float distance; // along the ray, world units
};

vec3 unit(vec3 v)
{
    return v * inversesqrt(dot(v, v));
}

// Texture coordinates at `place`, object units about the axis. The box may be larger than the profile's.
vec2 coordinates(vec3 place)
{
    vec3 p = place * object.specular.y - vec3(0.0, 0.0, object.specular.z);
    if (PROJECTION == PROJECTION_PLANAR) {
        return (p.xy + object.axis.xy * object.specular.y) / object.specular.w + 0.5;
    }
    float r = length(p.xy);
    float xi = r > 0.0 ? (PI + atan(p.y, p.x)) / (2.0 * PI) : 0.5;
    float eta = PROJECTION == PROJECTION_SPHERICAL ? 1.0 - atan(r, p.z - 0.5) / PI : p.z;
    return vec2(xi, eta);
}

// What a pixel's shadows are found from, world axes.
struct Place {
    vec3 point;
    vec3 normal;
    float depth; // along the view
};

// The part of a light that is seen.
float lit_part(uint n, Place place)
{
#ifdef SHADOWS
    if (n < SHADOW_LIGHTS) {
        vec4 towards = frame.lights[n].towards;
        float facing = dot(place.normal, towards.xyz);
        float slope = sqrt(max(1.0 - facing * facing, 0.0)) / max(facing, 0.05);
        return facing > 0.0 ? seen_of_light(n, place.point, place.normal, slope, place.depth, towards.w) : 0.0;
    }
#endif
    return 1.0;
}

// Of one light, in the turned space.
vec3 blinn_phong(vec3 towards, vec3 color, vec3 n, vec3 view)
{
    vec3 middle = towards + view;
    float aligned = dot(n, middle) * inversesqrt(max(dot(middle, middle), 1e-20));
    float highlight = pow(max(aligned, 0.0), scale_shininess.w);
    float facing = dot(n, towards);
    vec3 reflected = color * (albedo_strength.rgb * facing + albedo_strength.w * highlight);
    return facing > 0.0 ? reflected : vec3(0.0);
}

// Returns the colour of the environment in a direction of this height, the component along z of a unit vector.
vec3 sky(float height)
{
    return mix(frame.sky_down.rgb, frame.sky_up.rgb, 0.5 + 0.5 * height);
}

Shaded shade()
{
    Shaded s;
    uvec2 pixel = uvec2(gl_FragCoord.xy);
    float t = 1.0 / gl_FragCoord.w; // depth along the view
    float inverse_r = inversesqrt(max(dot(surface.xy, surface.xy), 1e-30));
    vec3 normal = vec3(surface.xy * (inverse_r * surface.z), surface.w);

    vec3 scale = scale_shininess.xyz;
    vec3 v = ray_dir_00 + float(pixel.x) * ray_dir_x + float(pixel.y) * ray_dir_y;
    vec3 dir = v * scale;
    float square = dot(dir, dir);
    float inverse_length = inversesqrt(square);
    vec3 view = dir * -inverse_length;
    Instance i = instance_of(instance_index);
    // The normal over the scale, times the product of all three.
    vec3 turned = unit(normal * (scale.yzx * scale.zxy));
    s.distance = t * (square * inverse_length);
    s.normal = rotate(i.rotation, turned);
    s.uv = coordinates(ray_eye + t * v);
    s.albedo = albedo_strength.rgb;

    // From inside, the back of the surface is lit as a surface of its own.
    vec3 lit = (dot(turned, view) < 0.0 ? -1.0 : 1.0) * turned;
    s.shading_normal = rotate(i.rotation, lit);
    vec3 color = s.albedo * ambient;
    vec3 ray = frame.dir_00.xyz + float(pixel.x) * frame.dir_x.xyz + float(pixel.y) * frame.dir_y.xyz;
    Place place = Place(frame.eye.xyz + t * ray, s.shading_normal, t);
    if (LIGHTS > 0u) {
        color += lit_part(0u, place) * blinn_phong(light_0.xyz, vec3(light_0.w, light_colors.xy), lit, view);
    }
    if (LIGHTS > 1u) {
        color += lit_part(1u, place) * blinn_phong(light_1.xyz, vec3(light_1.w, light_colors.zw), lit, view);
    }
    for (uint n = NEAR_LIGHTS; n < LIGHTS; ++n) {
        Light light = light_seen(i, n);
        color += blinn_phong(light.towards.xyz, light.color.rgb, lit, view);
    }
    if (ENVIRONMENT != 0u) {
        float height = s.shading_normal.z, facing = dot(lit, view);
        float reflected = 2.0 * facing * height - rotate(i.rotation, view).z;
        float glass = mix(0.04, 1.0, pow(1.0 - clamp(facing, 0.0, 1.0), 5.0));
        vec3 highlight = albedo_strength.w * mix(vec3(glass), s.albedo, object.axis.w);
        color += s.albedo * sky(height) + highlight * sky(mix(reflected, height, object.axis.z));
    }
    s.color = vec4(color, 1.0);
    return s;
}

#endif
