// Shading inputs: the instance and the first two lights in **turned space**, which has object axes and world lengths.
// Normals need no rotation there.
#ifndef LOOK_GLSL
#define LOOK_GLSL
#include "core/placement.glsl"

struct Look {
    vec4 rotation; // rotation of the instance
    vec4 scale_shininess;
    vec4 albedo_strength;
    vec3 ambient;
    Light light_0; // turned space; black if there is no light
    Light light_1;
#if SHADOWED
    vec3 position; // position of the instance, from the eye, world axes
#endif
#if HOST_SHADING
    uint instance; // number of the instance among all
#endif
};

// The first two lights. Entry files copy them like the blocks.
Light first_light;
Light second_light;

void take_lights()
{
    first_light = frame_block.lights[0];
    second_light = frame_block.lights[1];
}

Light turned_to(vec4 rotation, Light light)
{
    light.towards.xyz = rotate(conjugate(rotation), light.towards.xyz);
    return light;
}

Look look_of(Instance i)
{
    Look look;
    look.rotation = i.rotation;
    look.scale_shininess = vec4(scale_of(i), object.specular.y);
    look.albedo_strength = vec4(object.albedo.rgb, object.specular.x);
    look.ambient = frame.ambient.rgb;
    look.light_0 = turned_to(i.rotation, first_light);
    look.light_1 = turned_to(i.rotation, second_light);
#if SHADOWED
    look.position = i.position_sx.xyz;
#endif
    return look;
}

#endif
