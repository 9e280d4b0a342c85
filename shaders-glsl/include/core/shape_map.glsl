// The shape map: signed distance d(r, z) to the profile, bilinear between texels, and its gradient.
// Texel (i, j) is at r = (i + 1/2) h, z = 1 - (j + 1/2) h.
#ifndef SHAPE_MAP_GLSL
#define SHAPE_MAP_GLSL
#include "core/blocks.glsl"

layout(set = 1, binding = 0) uniform sampler2D shape_map;
layout(set = 1, binding = 4) uniform sampler2D shadow_maps[MAX_SHADOW_MAPS];
// The map of the current object, as `shape` is its block: that of the draw, or of a possible shadow caster.
bool is_shadow_map = false;
int shadow_map; // its index

vec4 gather_map(vec2 at)
{
    if (SHADOW != SHADOW_OFF && is_shadow_map) {
        return textureGather(shadow_maps[shadow_map], at);
    }
    return textureGather(shape_map, at);
}

vec4 filter_map(vec2 at)
{
    if (SHADOW != SHADOW_OFF && is_shadow_map) {
        return textureLod(shadow_maps[shadow_map], at, 0.0);
    }
    return textureLod(shape_map, at, 0.0);
}

// The four texels around a point and the point's position among them. The gather is aimed at their common corner, so
// that coordinate rounding cannot select others. Weights are full floats, where a sampler has only 8 bits.
struct Cell {
    vec4 d;     // order: (i, j+1), (i+1, j+1), (i+1, j), (i, j)
    vec2 position; // 0 to 1; extrapolated by half a texel beyond the centres of the outermost texels
};

Cell shape_cell(vec2 rz)
{
    vec2 size = shape.map_size;
    vec2 texel = vec2(rz.x, 1.0 - rz.y) * shape.map_size.y - 0.5;
    vec2 base = clamp(floor(texel), vec2(0.0), max(size - 2.0, 0.0));
    Cell cell;
    cell.d = gather_map((base + 1.0) * (1.0 / size)) * shape.map_scale;
    // The texel beyond the axis equals the first by symmetry.
    cell.position = vec2(max(texel.x - base.x, 0.0), texel.y - base.y);
    cell.position = clamp(cell.position, vec2(0.0, -0.5), vec2(1.5));
    return cell;
}

float cell_distance(Cell cell)
{
    vec2 across = mix(vec2(cell.d.w, cell.d.x), vec2(cell.d.z, cell.d.y), cell.position.x);
    return mix(across.x, across.y, cell.position.y);
}

// Returns d(d)/d(r, z) of the bilinear cell; its length is about 1.
vec2 cell_gradient(Cell cell)
{
    float dr = mix(cell.d.z - cell.d.w, cell.d.y - cell.d.x, cell.position.y);
    float dj = mix(cell.d.x - cell.d.w, cell.d.y - cell.d.z, cell.position.x);
    return vec2(dr, -dj) * shape.map_size.y;
}

vec2 papers_coordinates(vec2 rz)
{
    return vec2(rz.x, 1.0 - rz.y) / (shape.map_size * shape.texel);
}

float map_distance(vec2 rz)
{
    if (RGBA8 != 0u) {
        return filter_map(papers_coordinates(rz)).b * shape.map_scale;
    }
    return cell_distance(shape_cell(rz));
}

// Returns the gradient near corners of the outline. A cell at a corner blends the directions of both sides, so its
// gradient is shorter than 1. The tangents of both sides are then extrapolated from beyond the corner, and `along`, the
// ray's direction in the half-plane, selects one: the side entered last at a convex corner, first at a concave one.
vec2 creased_gradient(vec2 rz, vec2 along)
{
    vec2 g = cell_gradient(shape_cell(rz));
    float len = length(g);
    if (len > 0.99) {
        return g;
    }
    vec2 aside = vec2(-g.y, g.x) * (1.5 * shape.texel / max(len, 1e-3));
    Cell left = shape_cell(rz + aside);
    Cell right = shape_cell(rz - aside);
    vec2 g_left = cell_gradient(left);
    vec2 g_right = cell_gradient(right);
    float d_left = cell_distance(left) - dot(g_left, aside);
    float d_right = cell_distance(right) + dot(g_right, aside);
    float v_left = dot(g_left, along);
    float v_right = dot(g_right, along);
    if (v_left >= 0.0 || v_right >= 0.0) {
        return v_left < v_right ? g_left : g_right;
    }
    bool convex = dot(g_left - g_right, aside) > 0.0;
    return (-d_left / v_left > -d_right / v_right) == convex ? g_left : g_right;
}

// Returns the gradient of the map, not normalised.
vec2 map_gradient(vec2 rz, vec2 along)
{
    if (RGBA8 != 0u) {
        return filter_map(papers_coordinates(rz)).rg * 2.0 - 1.0;
    }
    return creased_gradient(rz, along);
}

#endif
