#version 450
#extension GL_GOOGLE_include_directive : require
// Places the copies that the host wrote without a view: makes the members that depend on it, with the precision of the
// CPU's double numbers: sums of two or three floats hold 48 bits and more. Other records are copied.
#define PLACES
#include "core/pixel_ray.glsl"
#include "stage/compute.glsl"

// Returns a + b; `error` is what rounding leaves out (Knuth 1969).
vec3 two_sum(vec3 a, vec3 b, out vec3 error)
{
    precise vec3 sum = a + b;
    precise vec3 second = sum - a;
    precise vec3 left_out = (a - (sum - second)) + (b - second);
    error = left_out;
    return sum;
}

// Returns `x` with 12 bits. Its products with other such numbers are exact.
float with_12_bits(float x)
{
    return uintBitsToFloat(floatBitsToUint(x) & 0xfffff000u);
}

// Returns the first vector of the table of a copy's level.
uint table_of(Instance i, float depth)
{
    LevelTables levels = objects[i.object].levels;
    float scale = max(i.scale.x, max(i.scale.y, i.scale.z));
    uint level = uint(dot(vec4(greaterThanEqual(vec4(depth), scale * levels.limits)), vec4(1.0)));
    return level < 4u ? levels.tables[level] : levels.last_table;
}

// Returns a copy as the view has it. The clip coordinates stay unset: nothing rasterises such copies.
Instance placed(Instance i)
{
    PlacedEye eye = frame_block.eye;
    vec3 error_0, error_1, error_2;
    vec3 near = two_sum(i.position, -eye.high, error_0);
    vec3 fine = two_sum(i.origin, -eye.middle, error_1);
    vec3 finest = vec3(i.depth, i.clip_x, i.clip_y) - eye.low;
    near = two_sum(near, fine, error_2);
    precise vec3 rest = error_2 + (error_0 + (error_1 + finest));
    vec3 position = two_sum(near, rest, error_0);
    rest = error_0;

    vec3 up = rotate(i.rotation, vec3(0.0, 0.0, 0.5 * i.scale.z));
    float depth = dot(position, frame.forward) + dot(up, frame.forward);
    // The products below are exact. Rays may begin in a plane beside the box's middle.
    float base = max(with_12_bits(depth), 0.0);
    near = two_sum(base * eye.dir_high, -position, error_0);
    fine = two_sum(base * eye.dir_middle, -rest, error_1);
    precise vec3 to_plane = near + (fine + (error_0 + (error_1 + base * eye.dir_low)));
    i.table = table_of(i, depth);
    i.listed = objects[i.object].levels.listed;
    i.position = position;
    i.depth = depth > 0.0 ? base : depth;
    i.origin = rotate(conjugate(i.rotation), to_plane) / i.scale - vec3(objects[i.object].object.shape.axis, 0.0);
    return i;
}

void main()
{
    load_frame(0u);
    uint number = pushed.first + gl_WorkGroupID.x * GROUP_PIXELS * GROUP_PIXELS + gl_LocalInvocationIndex;
    if (number < pushed.placed) {
        Instance i = written[number];
        if (i.table == PLACED) {
            i = placed(i);
        }
        instances[number] = i;
    }
}
