// What shading needs of the instance and of the first light, in the instance's turned space: object axes, world lengths. There normals
// need no rotation.
#ifndef LOOK_GLSL
#define LOOK_GLSL
#include "placement.glsl"

struct Look {
    vec4 scale_shininess;
    vec4 albedo_strength;
    vec3 ambient;
    vec3 towards; // the first light
    vec3 color;   // its
};

Look look_of(Instance i)
{
    Look look;
    look.scale_shininess = vec4(scale_of(i), solid.specular.y);
    look.albedo_strength = vec4(solid.albedo.rgb, solid.specular.x);
    look.ambient = frame.ambient.rgb;
    look.towards = rotate(conjugate(i.rotation), frame.lights[0].towards.xyz);
    look.color = frame.lights[0].color.rgb;
    return look;
}

#endif
