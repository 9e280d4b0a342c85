#version 450
#extension GL_GOOGLE_include_directive : require
// Vertices of proxies without patches; their fragments search the tree. Vertices 0 to 13 are the shape box, a strip
// that an index list unrolls. Strips of the box's sides follow, four vertices each, where a side cuts the solid or a
// shell of its cells. src/surface/hull.rs explains why the rest of the sides is not drawn.
#include "stage/vertex.glsl"
#include "stage/tree_varyings.glsl"
#include "core/patch_tables.glsl"

const uint BOX_VERTICES = 14u;

vec4 box_corner(Instance i, uint vertex)
{
    vec3 scale = scale_of(i);
    vec3 half_size = vec3(object.bounds.x, object.bounds.x, 0.5);
    vec3 forward = rotate(conjugate(i.rotation), frame.forward.xyz) * scale;
    float depth = i.scale_depth.z;
    float reach = dot(abs(forward), half_size);
    // The ray test sets the exact border of the box. The rasterized box is slightly larger, so it never clips first.
    half_size += 0.05 * frame.dir_00.w * max(depth, reach) / scale + 1e-5;
    // If the near plane cuts the box or the eye is inside it, the back faces are drawn at the near plane's depth.
    bool inside = depth - dot(abs(forward), half_size) <= frame.clip_y.w;
    uint bit = 1u << vertex;
    vec3 corner = vec3((0x287au & bit) != 0u, (0x02afu & bit) != 0u, (0x31e3u & bit) != 0u) * 2.0 - 1.0;
    corner.x = inside ? -corner.x : corner.x; // mirroring reverses the winding
    vec4 clip = clip_of(i, corner * half_size + vec3(0.0, 0.0, 0.5));
    clip.z = inside ? frame.ambient.w * clip.w : clip.z;
    return clip;
}

vec4 strip_corner(Instance i, uint vertex)
{
    uint strip = vertex >> 2;
    uint corner = vertex & 3u;
    uint side = strip & 3u;
    vec4 row = uintBitsToFloat(patch_tables[object.parts.w + (strip >> 2)]); // lowest and highest z, largest radius
    // Component 0 is along the side's normal, component 1 is the horizontal one across it.
    bool along_x = side < 2u;
    float sense = (side & 1u) == 0u ? 1.0 : -1.0;
    float R = object.bounds.x;
    vec2 axis = along_x ? object.axis.xy : object.axis.yx;
    float away = R - sense * axis.x;
    float reach = sqrt(max(row.z * row.z - away * away, 0.0));
    // The strip is widened so that the raster never clips first. A row that does not reach the side has zero width.
    vec3 grow = reach > 0.0 ? fraction_of_pixel(i) : vec3(0.0);
    float wider = along_x ? grow.y : grow.x;
    vec2 ends = clamp(axis.y + vec2(-reach, reach), -R, R) + vec2(-wider, wider);
    bool right = corner == 1u || corner == 2u;
    bool turned = along_x == (sense > 0.0);
    vec2 xy = vec2(sense * R, right == turned ? ends.y : ends.x);
    float z = corner >= 2u ? row.y + grow.z : row.x - grow.z;
    vec4 clip = clip_of(i, vec3(along_x ? xy : xy.yx, z));
    // The triangle moves slightly nearer, since no hit may be before it. An outward move would lose rays along the
    // side.
    clip.z += (frame.clip_x.w != 0.0 ? -1e-5 : 1e-5) * frame.dir_y.w;
    return clip;
}

void main()
{
    Instance i = begin(uint(gl_InstanceIndex));
    uint vertex = uint(gl_VertexIndex);
    if (vertex < BOX_VERTICES) {
        gl_Position = box_corner(i, vertex);
    } else {
        gl_Position = strip_corner(i, vertex - BOX_VERTICES);
    }
    hand_over(i, frame.dir_00.w);
    hand_over_tree(EVERYWHERE);
}
