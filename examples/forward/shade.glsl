// The host's function for revmap's solids: the host's light, on rings that are painted by texture coordinates.
#include "light.glsl"

vec4 host_shade(Surface s)
{
    // Rings on copies with an odd number, as wide as a pixel at their edges.
    float along = 8.0 * s.uv.y;
    float width = 8.0 * max(abs(s.uv_right.y) + abs(s.uv_down.y), 1e-4);
    float from_edge = abs(fract(along) - 0.5) - 0.25;
    float ring = (s.copy & 1u) * clamp(0.5 + from_edge / width, 0.0, 1.0);
    vec3 base = mix(s.base_color, vec3(0.85), ring);
    vec3 world = host_lights.eye.xyz + s.position;
    return vec4(host_lit(world, s.shading_normal, s.to_eye, base, s.roughness, s.metalness), 1.0);
}
