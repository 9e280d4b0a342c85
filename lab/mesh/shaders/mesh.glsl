// What the stages of the mesh baseline share: blocks, placement, and what vertices hand over.
#ifndef MESH_GLSL
#define MESH_GLSL

layout(constant_id = 0) const uint LIGHTS = 1u;     // number of lights
layout(constant_id = 1) const uint SINGLE = 0u;     // 1: one instance, in the object's block
layout(constant_id = 2) const uint PROJECTION = 1u; // one of PROJECTION_*

layout(constant_id = 4) const uint ENVIRONMENT = 0u; // 1: surfaces reflect the sky

const uint PROJECTION_PLANAR = 0u;
const uint PROJECTION_CYLINDRICAL = 1u;
const uint PROJECTION_SPHERICAL = 2u;

const uint MAX_LIGHTS = 8u;
const uint NEAR_LIGHTS = 2u; // lights that vertices hand over; fragments read the others

struct Light {
    vec4 towards; // unit, from the surface to the light; w: tangent of its angular radius
    vec4 color;   // linear RGB
};

// World = position + rotate(rotation, scale * object).
struct Instance {
    vec4 position_sx; // w: scale along x
    vec4 rotation;    // unit quaternion, x y z w
    vec4 scale_yz;    // scale along y and z
};

layout(set = 0, binding = 0, std140) uniform FrameBlock {
    mat4 clip_from_world;
    vec4 eye;     // world
    vec4 dir_00;  // ray through the centre of pixel (0, 0), forward component 1
    vec4 dir_x;   // its change from column to column
    vec4 dir_y;   // its change from row to row
    vec4 ambient; // linear RGB
    Light lights[MAX_LIGHTS];
    vec4 sky_up; // linear RGB of the environment straight up
    vec4 sky_down;
} frame;

layout(set = 0, binding = 1, std430) readonly buffer InstanceBlock {
    Instance instances[];
};

#ifdef CASTER
layout(push_constant) uniform CasterBlock {
    mat4 clip_from_world;
    vec4 axis; // as in ObjectBlock
} caster;
#else
layout(push_constant) uniform ObjectBlock {
    vec4 axis;     // x, y in object units from the middle of the box; z: roughness, w: metalness
    vec4 albedo;   // linear RGB; w: strength of the highlight
    vec4 specular; // x: shininess; of the box in units of the profile's box: y: height, z: height below z = 0, w: 2 R of the profile's
    Instance single;
} object;

#ifndef VARYING
#define VARYING in
#endif

// Flat varyings hold the same values for all of an instance. Software drivers read them faster in
// fragments than uniform buffers.
layout(location = 0) flat VARYING uint instance_index;
layout(location = 1) flat VARYING vec3 ray_eye; // object units about the axis
layout(location = 2) flat VARYING vec3 ray_dir_00;
layout(location = 3) flat VARYING vec3 ray_dir_x;
layout(location = 4) flat VARYING vec3 ray_dir_y;
layout(location = 5) flat VARYING vec4 scale_shininess;
layout(location = 6) flat VARYING vec4 albedo_strength;
layout(location = 7) flat VARYING vec3 ambient;
layout(location = 8) flat VARYING vec4 light_0;      // turned space; w: red of its colour
layout(location = 9) flat VARYING vec4 light_1;      // the same
layout(location = 10) flat VARYING vec4 light_colors; // green and blue of both
layout(location = 11) VARYING vec4 surface;          // x, y about the axis; normal (r, z)

Instance instance_of(uint index)
{
    if (SINGLE != 0u) {
        return object.single;
    }
    return instances[index];
}
#endif

vec3 rotate(vec4 q, vec3 v)
{
    vec3 t = 2.0 * cross(q.xyz, v);
    return v + q.w * t + cross(q.xyz, t);
}

vec4 conjugate(vec4 q)
{
    return vec4(-q.xyz, q.w);
}

vec3 scale_of(Instance i)
{
    return vec3(i.position_sx.w, i.scale_yz.xy);
}

// A light in the turned space of an instance: object axes, world lengths.
Light light_seen(Instance i, uint n)
{
    Light light = frame.lights[n];
    light.towards.xyz = rotate(conjugate(i.rotation), light.towards.xyz);
    return light;
}

#endif
