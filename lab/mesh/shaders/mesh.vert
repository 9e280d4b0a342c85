#version 450
#extension GL_GOOGLE_include_directive : require
// A vertex of a mesh. The azimuth of its normal is that of its position.
#define VARYING out
#include "mesh.glsl"

layout(location = 0) in vec3 position; // object units about the axis
layout(location = 1) in vec2 normal;   // (r, z) in the half-plane

void main()
{
    Instance i = instance_of(gl_InstanceIndex);
    vec3 scale = scale_of(i);
    vec4 back = conjugate(i.rotation);
    vec3 axis = vec3(object.axis.xy, 0.0);
    vec3 world = i.position_sx.xyz + rotate(i.rotation, scale * (position + axis));
    gl_Position = frame.clip_from_world * vec4(world, 1.0);
    surface = vec4(position.xy, normal);

    instance_index = gl_InstanceIndex;
    ray_eye = rotate(back, frame.eye.xyz - i.position_sx.xyz) / scale - axis;
    ray_dir_00 = rotate(back, frame.dir_00.xyz) / scale;
    ray_dir_x = rotate(back, frame.dir_x.xyz) / scale;
    ray_dir_y = rotate(back, frame.dir_y.xyz) / scale;
    scale_shininess = vec4(scale, object.specular.x);
    albedo_strength = object.albedo;
    ambient = frame.ambient.rgb;
    if (LIGHTS > 0u) {
        Light light = light_seen(i, 0u);
        light_0 = vec4(light.towards.xyz, light.color.r);
        light_colors = light.color.gbgb;
    }
    if (LIGHTS > 1u) {
        Light light = light_seen(i, 1u);
        light_1 = vec4(light.towards.xyz, light.color.r);
        light_colors.zw = light.color.gb;
    }
}
