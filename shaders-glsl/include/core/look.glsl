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
    vec3 position; // position of the instance, from the eye, world axes
    uint instance; // number of the instance among all
};

Light turned_to(vec4 rotation, Light light)
{
    light.towards = rotate(conjugate(rotation), light.towards);
    return light;
}

// `number`: that of the instance among all.
Look look_of(Instance i, uint number)
{
    Look look;
    look.rotation = i.rotation;
    look.scale_shininess = vec4(i.scale, appearance.shininess);
    look.albedo_strength = vec4(appearance.color, appearance.specular);
    look.ambient = frame.ambient;
    look.light_0 = turned_to(i.rotation, first_light);
    look.light_1 = turned_to(i.rotation, second_light);
    look.position = i.position;
    look.instance = number;
    return look;
}

#endif
