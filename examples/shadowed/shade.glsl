// The host's function for revmap's solids.
#include "sun.glsl"

vec4 host_shade(Surface s)
{
    return host_lit(host_sun.eye.xyz + s.position, s.normal, s.shading_normal, s.to_eye, s.base_color);
}
