// Shading by a function of the host, which defines `host_shade`. src/shading compiles it behind each entry file that
// shades, with HOST_SHADING.
#ifndef HOST_SHADING_GLSL
#define HOST_SHADING_GLSL
#ifdef HOST_SHADING

// A point of a solid in a pixel. Positions and directions have the world's axes and units.
struct Surface {
    vec3 position;       // relative to the eye
    float depth;         // along the view's forward axis
    vec3 to_eye;         // unit
    vec3 normal;         // unit, without bumps, towards the eye
    vec3 shading_normal; // unit, with bumps; differs from `normal` only where there are bumps
    vec3 base_color;     // linear RGB: the object's, or of its colour map
    float roughness;     // 0 to 1, as the next
    float metalness;
    vec2 uv;             // where the object's colour map is read: u around the axis, v downwards
    vec2 uv_right;       // change of uv a pixel to the right, or less if pixels have several rays (View::with_ray_width)
    vec2 uv_down;        // change of uv down, likewise
    uint object;         // ObjectId::number
    uint copy;           // number of the copy among the object's instances
    vec2 pixel;          // position in the picture, pixels from its upper left corner
};

// Returns the linear colour of a point.
vec4 host_shade(Surface surface);

Surface surface_of(Look look, PixelRays rays, vec2 pixel, Hit hit, Shaded s, Coordinates c)
{
    vec3 v = ray_direction(rays, pixel);
    vec3 way = rotate(look.rotation, v * look.scale_shininess.xyz); // of the ray per unit of depth
    vec2 material = unpackUnorm2x16(appearance.material);
    vec3 right, down;
    footprints(rays, v, hit, right, down);
    Surface surface;
    surface.depth = rays.base + hit.t;
    surface.position = surface.depth * way;
    surface.to_eye = way * -inversesqrt(dot(way, way));
    surface.normal = dot(s.normal, surface.to_eye) < 0.0 ? -s.normal : s.normal;
    surface.shading_normal = s.shading_normal;
    surface.base_color = s.albedo;
    surface.roughness = material.x;
    surface.metalness = material.y;
    surface.uv = map_position(c);
    surface.uv_right = map_change(c, right);
    surface.uv_down = map_change(c, down);
    surface.object = instances[look.instance].object;
    surface.copy = look.instance - appearance.first_instance;
    surface.pixel = pixel + 0.5;
    return surface;
}

#endif
#endif
