// What shading needs of the instance and of the first two lights, in the instance's turned space: object axes, world lengths. There
// normals need no rotation.
#ifndef LOOK_GLSL
#define LOOK_GLSL
#include "placement.glsl"

struct Look {
    vec4 scale_shininess;
    vec4 albedo_strength;
    vec3 ambient;
    Light lights[LOOK_LIGHTS]; // in that space
};

Light light_seen(Instance i, uint n)
{
    Light light = frame.lights[n];
    light.towards.xyz = rotate(conjugate(i.rotation), light.towards.xyz);
    return light;
}

Look look_of(Instance i)
{
    Look look;
    look.scale_shininess = vec4(scale_of(i), solid.specular.y);
    look.albedo_strength = vec4(solid.albedo.rgb, solid.specular.x);
    look.ambient = frame.ambient.rgb;
    for (uint n = 0u; n < min(LIGHTS, LOOK_LIGHTS); ++n) {
        look.lights[n] = light_seen(i, n);
    }
    return look;
}

#endif
