//! Pipelines compiled before they are needed.

use super::{RevmapRenderer, with};
use crate::fault::{RevmapResult, enter};
use crate::handle::{Handle, create, handle};
use crate::pointers::put;
use ash::vk;
use revmap::gpu::Prewarm;
use std::sync::Arc;

/// Pipelines that a renderer may come to need.
pub struct RevmapPrewarm;
handle!(RevmapPrewarm, "prewarm", Arc<Prewarm>);

/// Lists every pipeline that the objects can reach while parameters, lights, placements and the
/// view change. Other techniques make others necessary: textures where there were none, replicas,
/// shadows; in compute also more objects or copies than one. Nothing is compiled yet.
///
/// Thread: one at a time for a renderer.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn revmap_renderer_prewarm(
    renderer: *mut RevmapRenderer,
    prewarm: *mut *mut RevmapPrewarm,
) -> RevmapResult {
    // SAFETY: the caller's pointer.
    unsafe {
        create(prewarm, || {
            let listed = with(renderer, |r| Ok(r.renderer.prewarm()?))?;
            Ok(Arc::new(listed))
        })
    }
}

/// Compiles those that are not compiled yet. The renderer must live until this returns.
///
/// Thread: any, also while another thread uses the renderer.
#[unsafe(no_mangle)]
pub extern "C" fn revmap_prewarm_compile(prewarm: *const RevmapPrewarm) -> RevmapResult {
    enter(|| Ok(RevmapPrewarm::get(prewarm)?.compile()?))
}

/// Returns the number of pipelines, compiled or not.
///
/// Thread: any.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn revmap_prewarm_count(
    prewarm: *const RevmapPrewarm,
    count: *mut usize,
) -> RevmapResult {
    // SAFETY: the caller's pointer.
    enter(|| unsafe { put(count, "count", || Ok(RevmapPrewarm::get(prewarm)?.len())) })
}

/// Destroys the list; null is none. Compiled pipelines stay.
///
/// Thread: any.
#[unsafe(no_mangle)]
pub extern "C" fn revmap_prewarm_destroy(prewarm: *mut RevmapPrewarm) -> RevmapResult {
    enter(|| RevmapPrewarm::destroy(prewarm))
}

/// Records draws of no pixel, or dispatches of no group, with every pipeline of
/// revmap_renderer_prewarm(): some drivers compile shaders at the first draw, and do it when these
/// commands run. In a pass it sets the scissor, too, to nothing.
///
/// The slot is prepared; the caller meets the conditions of revmap_renderer_record() or
/// revmap_renderer_record_compute().
///
/// Thread: one at a time for a renderer.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn revmap_renderer_record_prewarm(
    renderer: *mut RevmapRenderer,
    command_buffer: vk::CommandBuffer,
    slot: u32,
) -> RevmapResult {
    enter(|| {
        with(renderer, |r| {
            let frame = r.frame(command_buffer, slot)?;
            // SAFETY: the slot was prepared; the rest the caller has promised.
            Ok(unsafe { r.renderer.record_prewarm(command_buffer, frame) }?)
        })
    })
}
