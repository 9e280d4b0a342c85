// Conversion of linear light to sRGB (IEC 61966-2-1), packed into 8 bits per channel.
#ifndef SRGB_GLSL
#define SRGB_GLSL

vec3 linear_to_srgb(vec3 c)
{
    c = clamp(c, 0.0, 1.0);
    return mix(1.055 * pow(c, vec3(1.0 / 2.4)) - 0.055, 12.92 * c, vec3(lessThanEqual(c, vec3(0.0031308))));
}

uint pack_srgb(vec4 c)
{
    return packUnorm4x8(vec4(linear_to_srgb(c.rgb), clamp(c.a, 0.0, 1.0)));
}

#endif
