#version 450
#extension GL_GOOGLE_include_directive : require
// The floor of tiles with lists of patches: a ray hits where it enters the solid's bounding cylinder. No list is read.
#include "stage/tile.glsl"

void main()
{
    load_frame(pushed.object);
    load_tile();
    tile_instance = instances[instance_number()];
    load(tile_instance);
    begin_tile();
    uvec2 pixel = tile_corner() + gl_LocalInvocationID.xy;
    vec3 o = ray_origin(tile_rays, pixel);
    vec3 v = ray_direction(tile_rays, pixel);
    float a = dot(v.xy, v.xy);
    float b = dot(o.xy, v.xy);
    float inside = b * b - a * (dot(o.xy, o.xy) - shape.clip_radius * shape.clip_radius);
    Hit hit = NO_HIT;
    hit.t = -(b + sqrt(max(inside, 0.0))) / a;
    hit.point = o + hit.t * v;
    hit.normal = vec3(hit.point.xy, 0.0);
    store_tile(pixel, true, hit);
}
