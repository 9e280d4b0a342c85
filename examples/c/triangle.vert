#version 450
// A triangle in world space, without a vertex buffer.
layout(push_constant) uniform Pushed { mat4 clip_from_world; };
layout(location = 0) out vec3 color;

const vec3 POSITIONS[3] = vec3[](vec3(0.05, -0.75, 0.05), vec3(0.05, 0.75, 0.05), vec3(0.05, 0.0, 1.15));
const vec3 COLORS[3] = vec3[](vec3(0.9, 0.2, 0.1), vec3(0.1, 0.5, 0.9), vec3(0.9, 0.8, 0.2));

void main()
{
    gl_Position = clip_from_world * vec4(POSITIONS[gl_VertexIndex], 1.0);
    color = COLORS[gl_VertexIndex];
}
