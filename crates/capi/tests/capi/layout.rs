//! Structures are laid out in C and C++ as in Rust, Vulkan's types among them.

use crate::names::*;
use crate::programs::{compiler, folder, run};
use std::fmt::Write;
use std::mem::offset_of;

/// Assertions of a structure's size and of where some of its fields are.
macro_rules! assertions {
    ($($name:ident { $($field:ident),* })*) => {{
        let mut text = String::from("#include <revmap.h>\n#include <assert.h>\n");
        $(
            let (name, size) = (stringify!($name), size_of::<$name>());
            writeln!(text, "static_assert(sizeof({name}) == {size}, \"{name}\");").unwrap();
            $(
                let (field, at) = (stringify!($field), offset_of!($name, $field));
                writeln!(text, "static_assert(offsetof({name}, {field}) == {at}, \"{name}.{field}\");").unwrap();
            )*
        )*
        text
    }};
}

/// The header comes first, so it compiles alone; in C99 it does in `programs.rs`.
#[test]
fn structures_are_the_same_in_every_standard() {
    let text = assertions! {
        RevmapPlacement { rotation, scale }
        RevmapOffset { chamfer }
        RevmapLight { color, radius }
        RevmapLighting { ambient, light_count, lights, environment_up, environment_down }
        RevmapCamera { eye, target, up, fov_y }
        RevmapView { view, projection, viewport, last, jitter, depth_bias, mask, layer, depth_range, ray_width }
        RevmapSearch { proxy_min_pixels, tolerance }
        RevmapRequirements { features }
        RevmapHostDevice { get_instance_proc_addr, physical_device, queue, features, pipeline_cache }
        RevmapDeviceInfo { pipelines_compiled, name, driver }
        RevmapObjectInfo { profile, height_map, color, bump, offset, repeat, placement, instances, instance_count, has_material, metalness }
        RevmapPass { render_pass, color_formats, color_format_count, stencil_format, attachments, sample_rays, depth_compare, depth_read_only, views, slope_bias, slope_bias_limit }
        RevmapComputeTarget { words, images }
        RevmapStatistics { surfaces_made, notes }
        RevmapFrameStatistics { hidden, tiles, slot_bytes, prepare_ms, record_ms }
        RevmapMemoryUse { device, visible, host }
        RevmapRay { direction }
        RevmapRayHit { normal, copy, leaves }
        RevmapBounds { high }
        RevmapPicture { search }
        RevmapScene { camera, lighting, objects, object_count }
        RevmapTimes { prepare_ms, frame_ms }
    };
    let folder = folder();
    for (name, standard) in [("cc", "c11"), ("cc", "c17"), ("c++", "c++17")] {
        let ending = if name == "cc" { "c" } else { "cpp" };
        let file = folder.path().join(format!("layout.{ending}"));
        std::fs::write(&file, &text).unwrap();
        run(compiler(name, standard, &["-fsyntax-only"]).arg(file));
    }
}
