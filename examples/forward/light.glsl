// The host's light, for meshes and solids alike: a sun and lamps on metals and other surfaces (GGX, Walter et al. 2007;
// Schlick 1994). LIGHT_SET is the set that holds the lamps.
#ifndef LIGHT_SET
#define LIGHT_SET 3
#endif
#define LAMPS 3

layout(set = LIGHT_SET, binding = 0, std140) uniform HostLights {
    vec4 eye;                // world position
    vec4 towards_sun;        // unit
    vec4 sun_color;          // linear RGB
    vec4 sky_color;
    vec4 lamp_places[LAMPS]; // world positions
    vec4 lamp_colors[LAMPS];
} host_lights;

vec3 host_reflected(vec3 to_light, vec3 n, vec3 to_eye, vec3 base, float roughness, float metalness)
{
    vec3 middle = normalize(to_light + to_eye);
    float l = max(dot(n, to_light), 0.0);
    float e = max(dot(n, to_eye), 1e-3);
    float h = max(dot(n, middle), 0.0);
    float a = roughness * roughness;
    float width = h * h * (a * a - 1.0) + 1.0;
    float spread = a * a / (3.14159265 * width * width);
    float hidden = 0.5 / mix(2.0 * l * e, l + e, a); // Hammon 2017
    vec3 mirrored = mix(vec3(0.04), base, metalness);
    vec3 fresnel = mirrored + (1.0 - mirrored) * pow(1.0 - max(dot(middle, to_eye), 0.0), 5.0);
    vec3 diffuse = (1.0 - metalness) * (1.0 - fresnel) * base / 3.14159265;
    return l * (diffuse + fresnel * spread * hidden);
}

vec3 host_lit(vec3 world, vec3 n, vec3 to_eye, vec3 base, float roughness, float metalness)
{
    vec3 color = mix(0.5, 1.0, 0.5 + 0.5 * n.z) * host_lights.sky_color.rgb * base;
    color += host_lights.sun_color.rgb
        * host_reflected(host_lights.towards_sun.xyz, n, to_eye, base, roughness, metalness);
    for (int k = 0; k < LAMPS; ++k) {
        vec3 way = host_lights.lamp_places[k].xyz - world;
        color += host_lights.lamp_colors[k].rgb / dot(way, way)
            * host_reflected(normalize(way), n, to_eye, base, roughness, metalness);
    }
    return color / (1.0 + color); // to the range of the screen (Reinhard et al. 2002)
}
