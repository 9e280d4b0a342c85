#version 450
// Planes of the G-buffer for a mesh. Its motion follows from its depth, since it stands still.
layout(location = 0) in vec3 color;
layout(location = 1) in vec3 world_normal;
layout(location = 0) out vec4 base_color;
layout(location = 1) out vec2 octahedral;
layout(location = 2) out vec2 material;
layout(location = 3) out vec2 motion;
layout(location = 4) out uvec2 identity;

void main()
{
    vec3 n = normalize(world_normal);
    vec2 p = n.xy / (abs(n.x) + abs(n.y) + abs(n.z));
    vec2 sense = mix(vec2(-1.0), vec2(1.0), greaterThanEqual(p, vec2(0.0)));
    base_color = vec4(color, 1.0);
    octahedral = n.z >= 0.0 ? p : (1.0 - abs(p.yx)) * sense;
    material = vec2(0.6, 0.0);
    motion = vec2(0.0);
    identity = uvec2(~0u);
}
