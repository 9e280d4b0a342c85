// The host's sun behind its shadow map, for meshes and solids alike. LIGHT_SET is the set that holds both.
#ifndef LIGHT_SET
#define LIGHT_SET 3
#endif

layout(set = LIGHT_SET, binding = 0, std140) uniform HostSun {
    vec4 eye;            // world position
    vec4 towards;        // unit
    vec4 color;          // linear RGB
    vec4 sky;            // linear RGB
    vec4 texel;          // side of a texel: in the world, as a part of the map
    mat4 map_from_world; // to texture coordinates and depth
} host_sun;
layout(set = LIGHT_SET, binding = 1) uniform sampler2DShadow host_map;

// The visible part of the sun at a point with the unit normal n. Each of 3 x 3 look-ups compares 2 x 2 texels.
float host_sunlit(vec3 world, vec3 n)
{
    float facing = dot(n, host_sun.towards.xyz);
    if (facing <= 0.0) {
        return 0.0;
    }
    // All texels are within 2 sqrt(2) texels, d, of the point. A plane is nearer to the sun there by up to
    // d sine / facing. A move by d sine along the normal brings the point as much nearer.
    float sine = sqrt(max(1.0 - facing * facing, 0.0));
    vec3 moved = world + 2.83 * host_sun.texel.x * sine * n;
    vec3 at = (host_sun.map_from_world * vec4(moved, 1.0)).xyz;
    float sum = 0.0;
    for (int y = -1; y <= 1; ++y) {
        for (int x = -1; x <= 1; ++x) {
            sum += textureLod(host_map, at + vec3(host_sun.texel.y * vec2(x, y), 0.0), 0.0);
        }
    }
    return sum / 9.0;
}

// The colour of a surface. Its alpha is the visible part of the sun.
vec4 host_lit(vec3 world, vec3 n, vec3 shading_n, vec3 to_eye, vec3 base)
{
    vec3 to_sun = host_sun.towards.xyz;
    float sunlit = host_sunlit(world, n);
    float facing = max(dot(shading_n, to_sun), 0.0);
    float glint = pow(max(dot(shading_n, normalize(to_sun + to_eye)), 0.0), 40.0);
    vec3 color = mix(0.5, 1.0, 0.5 + 0.5 * shading_n.z) * host_sun.sky.rgb * base;
    color += sunlit * facing * host_sun.color.rgb * (base + 0.15 * glint);
    return vec4(color / (1.0 + color), sunlit); // to the range of the screen (Reinhard et al. 2002)
}
