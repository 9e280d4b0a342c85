#version 450
#extension GL_GOOGLE_include_directive : require
// Lights a pixel of the G-buffer: one sun with a GGX highlight, and a sky. `matrix`: world from clip space. `first`:
// the eye. `second`: towards the sun.
#include "buffers.glsl"

void main()
{
    ivec2 p = ivec2(gl_GlobalInvocationID.xy);
    ivec2 size = imageSize(lit);
    if (any(greaterThanEqual(p, size))) {
        return;
    }
    float z = texelFetch(depth, p, 0).x;
    if (z == 1.0) {
        imageStore(lit, p, vec4(0.32, 0.4, 0.5, 1.0));
        return;
    }
    vec4 world = pushed.matrix * vec4(2.0 * (vec2(p) + 0.5) / vec2(size) - 1.0, z, 1.0);
    vec2 e = texelFetch(octahedral, p, 0).xy;
    vec3 n = vec3(e, 1.0 - abs(e.x) - abs(e.y));
    float fold = max(-n.z, 0.0);
    n.xy -= mix(vec2(-fold), vec2(fold), greaterThanEqual(n.xy, vec2(0.0)));
    n = normalize(n);
    vec3 base = texelFetch(base_color, p, 0).rgb;
    vec2 surface = texelFetch(material, p, 0).xy;
    vec3 v = normalize(pushed.first.xyz - world.xyz / world.w);
    vec3 l = pushed.second.xyz;
    vec3 h = normalize(v + l);
    float facing = max(dot(n, l), 0.0);
    float a = surface.x * surface.x;
    float d = dot(n, h) * dot(n, h) * (a * a - 1.0) + 1.0;
    float highlight = a * a / (3.14159 * d * d) * facing;
    vec3 reflectance = mix(vec3(0.04), base, surface.y);
    vec3 diffuse = base * (1.0 - surface.y);
    vec3 sky = mix(vec3(0.10, 0.09, 0.08), vec3(0.25, 0.3, 0.38), 0.5 + 0.5 * n.z);
    imageStore(lit, p, vec4(diffuse * (sky + facing) + reflectance * (highlight + sky), 1.0));
}
