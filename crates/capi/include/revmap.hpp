// Owners and exceptions for revmap.h, C++17. All else is called as in C, through check().
#ifndef REVMAP_HPP
#define REVMAP_HPP

#include <memory>
#include <stdexcept>

#include "revmap.h"

namespace revmap {

// A call that failed: what() is its text.
struct Error : std::runtime_error {
    RevmapResult result;
    explicit Error(RevmapResult failed) : std::runtime_error(revmap_last_error_text()), result(failed) {}
};

inline void check(RevmapResult result)
{
    if (result != REVMAP_RESULT_OK) {
        throw Error(result);
    }
}

// A structure with its size set and all else zero, for those without defaults.
template <typename T>
T sized()
{
    T value{};
    value.size = sizeof(T);
    return value;
}

// A structure with its defaults: defaulted(revmap_scene_defaults).
template <typename T>
T defaulted(RevmapResult (*fill)(T *))
{
    T value = sized<T>();
    check(fill(&value));
    return value;
}

template <typename T, RevmapResult (*destroy)(T *)>
struct Destroy {
    void operator()(T *handle) const noexcept { destroy(handle); }
};
template <typename T, RevmapResult (*destroy)(T *)>
using Owner = std::unique_ptr<T, Destroy<T, destroy>>;

using Device = Owner<RevmapDevice, revmap_device_destroy>;
using Profile = Owner<RevmapProfile, revmap_profile_destroy>;
using ColorMap = Owner<RevmapColorMap, revmap_color_map_destroy>;
using HeightMap = Owner<RevmapHeightMap, revmap_height_map_destroy>;
using RayCaster = Owner<RevmapRayCaster, revmap_ray_caster_destroy>;
using Shading = Owner<RevmapShading, revmap_shading_destroy>;
using HostImage = Owner<RevmapHostImage, revmap_host_image_destroy>;
using Renderer = Owner<RevmapRenderer, revmap_renderer_destroy>;
using Prewarm = Owner<RevmapPrewarm, revmap_prewarm_destroy>;
using Offscreen = Owner<RevmapOffscreen, revmap_offscreen_destroy>;

// The owner of what a function makes: make<Device>(revmap_device_open, nullptr, 0).
template <typename Owned, typename Function, typename... Arguments>
Owned make(Function function, Arguments... arguments)
{
    typename Owned::pointer handle = nullptr;
    check(function(arguments..., &handle));
    return Owned(handle);
}

} // namespace revmap

#endif
