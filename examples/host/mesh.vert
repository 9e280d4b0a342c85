#version 450
// A host's mesh: position and normal, lit by one light.
layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
layout(push_constant) uniform Pushed {
    mat4 clip_from_world;
    vec4 offset_scale; // world = offset + scale * position
    vec4 color;
    vec4 towards_light;
} pushed;
layout(location = 0) out vec3 color;

void main()
{
    vec3 world = pushed.offset_scale.xyz + pushed.offset_scale.w * position;
    gl_Position = pushed.clip_from_world * vec4(world, 1.0);
    color = pushed.color.rgb * (0.15 + 0.85 * max(dot(normal, pushed.towards_light.xyz), 0.0));
}
