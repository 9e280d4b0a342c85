// The ray in the half-plane (r, z): with the axis as origin, r(s)^2 = a s^2 + 2 b s + c and z(s) = z0 + s vz, a branch
// of a hyperbola. s = 0 is where the ray enters the searched region, which keeps the cancellation in r^2 small.
#ifndef MERIDIAN_GLSL
#define MERIDIAN_GLSL
#include "core/blocks.glsl"

const uint FACE_X = 0u;
const uint FACE_Y = 1u;
const uint FACE_Z = 2u;
const uint FACE_NONE = 3u; // the start of the ray, or the clipping cylinder

// What rays from one point have in common.
struct RayStart {
    bool to_light;
    bool is_known; // an earlier ray has found `is_within`
    bool is_within; // the point is in the solid
};

const RayStart FROM_EYE = RayStart(false, false, false);
const RayStart TO_LIGHT = RayStart(true, false, false);

struct Meridian {
    vec3 o; // point at s = 0, relative to the axis
    vec3 v; // direction per unit of s (and of t)
    float a, b, c;
    float inverse_speed; // 1 / (object units per unit of s)
    float t_start;       // t = t_start + s
    float base;          // the eye is at t = -base
    float s_end;         // exit from the searched region
    uint face_in;        // face of entry
    uint face_out;       // face of exit
    bool from_eye;       // the ray starts within the box
    bool to_light;       // the ray starts in a point that is shaded, not in the eye
};

vec2 point_rz(Meridian m, float s)
{
    float rr = (m.a * s + 2.0 * m.b) * s + m.c;
    return vec2(sqrt(max(rr, 0.0)), m.o.z + s * m.v.z);
}

// Clips the ray `eye + t v`, t >= start, to the box, the solid's height and the cylinder around it. Returns false if
// the ray misses them. There is a single return: software drivers execute both sides of a branch, and an early return
// adds a lane mask to all that follows.
bool clip_ray(vec3 eye, vec3 v, float base, float start, out Meridian m)
{
    float R = shape.half_side;
    vec3 low = vec3(-R - shape.axis, shape.clip_low);
    vec3 high = vec3(R - shape.axis, shape.clip_high);
    // A zero component gives infinities of the right sign. The exception is a point on a face, where 0 * inf is NaN.
    vec3 inverse = 1.0 / v;
    vec3 t_low = (low - eye) * inverse;
    vec3 t_high = (high - eye) * inverse;
    vec3 near = min(t_low, t_high);
    vec3 far = max(t_low, t_high);
    bvec3 still = equal(v, vec3(0.0));
    near = mix(near, vec3(-1e30), still);
    far = mix(far, vec3(1e30), still);
    bvec3 beside = bvec3(uvec3(still) * (uvec3(lessThan(eye, low)) + uvec3(greaterThan(eye, high))));

    float t_in = max(near.x, max(near.y, near.z));
    float t_out = min(far.x, min(far.y, far.z));
    m.face_in = t_in == near.z ? FACE_Z : t_in == near.x ? FACE_X : FACE_Y;
    m.face_out = t_out == far.z ? FACE_Z : t_out == far.x ? FACE_X : FACE_Y;
    m.from_eye = t_in <= start;
    m.face_in = m.from_eye ? FACE_NONE : m.face_in;
    t_in = max(t_in, start);

    m.base = base;
    m.v = v;
    m.a = dot(v.xy, v.xy);
    vec3 o = eye + t_in * v;
    float b = dot(o.xy, v.xy);
    float c = dot(o.xy, o.xy);
    float radius2 = shape.clip_radius * shape.clip_radius;
    float inside = b * b - m.a * (c - radius2);
    float root = sqrt(max(inside, 0.0));
    bool along_axis = !(m.a > 0.0);
    float enter = along_axis ? 0.0 : (-b - root) / m.a;
    float leave = along_axis ? 1e30 : (-b + root) / m.a;
    float s_end = t_out - t_in;
    m.face_in = enter > 0.0 ? FACE_NONE : m.face_in;
    m.face_out = leave < s_end ? FACE_NONE : m.face_out;
    enter = max(enter, 0.0);
    s_end = min(s_end, leave);

    m.t_start = t_in + enter;
    m.o = o + enter * v;
    m.b = dot(m.o.xy, v.xy);
    m.c = dot(m.o.xy, m.o.xy);
    m.s_end = s_end - enter;
    m.inverse_speed = inversesqrt(dot(v, v));
    return !any(beside) && t_in <= t_out && (along_axis ? c <= radius2 : inside > 0.0) && enter <= s_end;
}

// Returns the range of t in which a ray is within the four sides of a box: low x, low y, high x, high y.
vec2 between_sides(vec3 o, vec3 v, vec4 sides)
{
    vec2 inverse = 1.0 / mix(v.xy, vec2(1e-30), equal(v.xy, vec2(0.0)));
    vec2 t_low = (sides.xy - o.xy) * inverse;
    vec2 t_high = (sides.zw - o.xy) * inverse;
    vec2 near = min(t_low, t_high);
    vec2 far = max(t_low, t_high);
    return vec2(max(near.x, near.y), min(far.x, far.y));
}

// Returns the sides of the solid's box, relative to its axis.
vec4 sides_of_box()
{
    return vec4(-vec2(shape.half_side), vec2(shape.half_side)) - shape.axis.xyxy;
}

vec3 face_normal(uint face, vec3 v, float sense)
{
    return sense * sign(v) * vec3(face == FACE_X, face == FACE_Y, face != FACE_X && face != FACE_Y);
}

#endif
