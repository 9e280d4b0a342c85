// The part of a light that a point sees, by shadow maps.
#ifndef SHADOW_GLSL
#define SHADOW_GLSL
#include "mesh.glsl"

layout(constant_id = 3) const uint SOFT = 0u; // 1: penumbrae of the light's disc (Fernando 2005)

const uint CASCADES = 3u;
const uint SHADOW_LIGHTS = 2u;
const uint TAPS = 16u; // of the search for what shades, and of the penumbra
const float PI = 3.14159265358979;

// One map: a square of the atlas.
struct ShadowMap {
    mat4 atlas_from_world; // z: depth from the light
    vec4 square;           // corners in the atlas, half a texel inwards
    vec4 facts;            // x: depth of the camera at which the next map begins; y: texel, z: depths, world units
    vec4 per_unit;         // width and height in the atlas of a world unit
};

layout(set = 1, binding = 0, std140) uniform ShadowBlock {
    ShadowMap maps[SHADOW_LIGHTS * CASCADES];
} shadows;
layout(set = 1, binding = 1) uniform sampler2DShadow atlas;
layout(set = 1, binding = 2) uniform sampler2D atlas_depths;

// Tap `k` of a disc of radius 1, in a spiral (Vogel 1979) from an angle.
vec2 tap(uint k, float begin)
{
    float angle = begin + 2.39996323 * float(k);
    return sqrt((float(k) + 0.5) / float(TAPS)) * vec2(cos(angle), sin(angle));
}

// `point`, `normal` and `towards` in world axes; `slope`: tangent of the angle between the last two; `depth`: along the
// view; `spread`: tangent of the light's angular radius.
float seen_of_light(uint light, vec3 point, vec3 normal, float slope, float depth, float spread)
{
    uint n = CASCADES * light;
    uint last = n + CASCADES - 1u;
    while (n < last && depth > shadows.maps[n].facts.x) {
        ++n;
    }
    ShadowMap map = shadows.maps[n];
    vec3 lifted = point + normal * (map.facts.y * min(0.5 + slope, 3.0));
    vec3 at = (map.atlas_from_world * vec4(lifted, 1.0)).xyz;
    if (SOFT == 0u || spread == 0.0) {
        return texture(atlas, at);
    }
    // Interleaved gradient noise (Jimenez 2014).
    float begin = 2.0 * PI * fract(52.9829189 * fract(dot(gl_FragCoord.xy, vec2(0.06711056, 0.00583715))));
    vec2 per_unit = map.per_unit.xy;
    float widest = spread * at.z * map.facts.z; // at the depth of the first caster
    float sum = 0.0;
    float count = 0.0;
    for (uint k = 0u; k < TAPS; ++k) {
        vec2 place = clamp(at.xy + widest * per_unit * tap(k, begin), map.square.xy, map.square.zw);
        float found = texture(atlas_depths, place).r;
        float is_before = step(found, at.z);
        sum += is_before * found;
        count += is_before;
    }
    if (count == 0.0) {
        return 1.0;
    }
    float penumbra = max(spread * (at.z - sum / count) * map.facts.z, map.facts.y);
    float lit = 0.0;
    for (uint k = 0u; k < TAPS; ++k) {
        vec2 place = clamp(at.xy + penumbra * per_unit * tap(k, begin), map.square.xy, map.square.zw);
        // The taps lie in the plane of the light; a receiver that slopes away would shade itself.
        lit += texture(atlas, vec3(place, at.z - slope * penumbra / map.facts.z * 0.25));
    }
    return lit / float(TAPS);
}

#endif
