//! Renderers whose hits a host's function shades.

use super::{RevmapPass, RevmapRenderer, recorder, with};
use crate::device::RevmapDevice;
use crate::enums;
use crate::fault::{Outcome, RevmapResult, enter};
use crate::handle::{Handle, create};
use crate::pointers::{put, read};
use crate::shading::RevmapShading;
use crate::values::RevmapSearch;
use ash::vk;
use revmap::gpu::{HostShading, Output};

fn host_shading(
    shading: *const RevmapShading,
    set_layout: vk::DescriptorSetLayout,
) -> Outcome<HostShading> {
    Ok(HostShading {
        shading: RevmapShading::get(shading)?,
        set_layout,
    })
}

/// Makes a renderer as revmap_renderer_create() does, with a host's function that shades in place of
/// the library's. The function takes no lights of revmap_renderer_set_lighting(). set_layout is the
/// layout of descriptor set 3, for fragments; null if the function reads none. The layout has every
/// binding that the function reads, and lives as long as the renderer.
///
/// Whenever the renderer records, a set of the layout is bound at number 3 with
/// revmap_renderer_pipeline_layout().
///
/// Fails with REVMAP_RESULT_USAGE for a shading of the other stage, for a pass without colour, and for
/// a function that reads set 3 if the layout is null.
///
/// Thread: any.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn revmap_renderer_create_with_shading(
    device: *const RevmapDevice,
    pass: *const RevmapPass,
    shading: *const RevmapShading,
    set_layout: vk::DescriptorSetLayout,
    search: *const RevmapSearch,
    frames: u32,
    renderer: *mut *mut RevmapRenderer,
) -> RevmapResult {
    // SAFETY: the caller's pointers and handles.
    unsafe {
        create(renderer, || {
            let output = Output::Pass(read(pass)?.formats()?);
            let host = host_shading(shading, set_layout)?;
            recorder(device, output, search, frames, Some(&host))
        })
    }
}

/// Makes a renderer as revmap_renderer_create_compute() does, with a host's function that shades as in
/// revmap_renderer_create_with_shading(). planes must be REVMAP_PLANES_COLOR; set_layout is for
/// compute.
///
/// Thread: any.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn revmap_renderer_create_compute_with_shading(
    device: *const RevmapDevice,
    planes: u32,
    shading: *const RevmapShading,
    set_layout: vk::DescriptorSetLayout,
    search: *const RevmapSearch,
    frames: u32,
    renderer: *mut *mut RevmapRenderer,
) -> RevmapResult {
    // SAFETY: the caller's pointers and handles.
    unsafe {
        create(renderer, || {
            let output = Output::Compute(enums::planes(planes)?);
            let host = host_shading(shading, set_layout)?;
            recorder(device, output, search, frames, Some(&host))
        })
    }
}

/// Returns the layout of all pipelines of a renderer, with which a host binds its set 3. The layout
/// lives as long as the renderer.
///
/// Thread: one at a time for a renderer.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn revmap_renderer_pipeline_layout(
    renderer: *mut RevmapRenderer,
    layout: *mut vk::PipelineLayout,
) -> RevmapResult {
    // SAFETY: the caller's pointer.
    enter(|| unsafe {
        put(layout, "layout", || {
            with(renderer, |r| Ok(r.renderer.pipeline_layout()?))
        })
    })
}
