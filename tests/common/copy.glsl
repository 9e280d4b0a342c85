// The library's own light as a host's function, from the host's set.
layout(set = 3, binding = 0, std140) uniform HostLights {
    vec4 ambient;
    vec4 towards[3];
    vec4 radiance[3];
    vec4 specular; // strength, shininess
} host;

vec4 host_shade(Surface s)
{
    vec3 color = s.base_color * host.ambient.rgb;
    for (int k = 0; k < 3; ++k) {
        vec3 middle = normalize(host.towards[k].xyz + s.to_eye);
        float highlight = pow(max(dot(s.shading_normal, middle), 0.0), host.specular.y);
        float facing = dot(s.shading_normal, host.towards[k].xyz);
        vec3 reflected = host.radiance[k].rgb * (s.base_color * facing + host.specular.x * highlight);
        color += facing > 0.0 ? reflected : vec3(0.0);
    }
    return vec4(color, 1.0);
}
