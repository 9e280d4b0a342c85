//! A frame of a renderer: prepared, then recorded. Pipelines compiled before they are needed.

use super::{Recorder, RevmapRenderer};
use crate::fault::{Fault, Outcome, RevmapResult, enter};
use crate::handle::{Handle, create, enter_with, handle, with};
use crate::pointers::put;
use crate::structures::read;
use crate::values::{RevmapCamera, RevmapView};
use ash::vk;
use ash::vk::Handle as _;
use revmap::gpu::{PreparedFrame, Prewarm, View};
use std::sync::Arc;

impl Recorder {
    unsafe fn prepare(&mut self, cmd: vk::CommandBuffer, slot: u32, view: &View) -> Outcome<()> {
        if cmd.is_null() {
            return Err(Fault::usage("the VkCommandBuffer is null"));
        }
        let (frame, error) = match self.renderer.prepare(cmd, slot as usize, view) {
            Ok(frame) => (Some(frame), Ok(())),
            Err(error) => (None, Err(error.into())),
        };
        if let Some(prepared) = self.prepared.get_mut(slot as usize) {
            *prepared = frame;
        }
        error
    }

    /// The frame of a slot, to be recorded.
    fn frame(&self, cmd: vk::CommandBuffer, slot: u32) -> Outcome<&PreparedFrame> {
        if cmd.is_null() {
            return Err(Fault::usage("the VkCommandBuffer is null"));
        }
        self.prepared(slot)
    }

    /// The frame of a slot.
    pub(super) fn prepared(&self, slot: u32) -> Outcome<&PreparedFrame> {
        let prepared = self.prepared.get(slot as usize);
        let message = || format!("slot {slot} is not prepared; call revmap_renderer_prepare first");
        let frame = prepared.and_then(Option::as_ref);
        frame.ok_or_else(|| Fault::usage(message()))
    }
}

/// Prepares the frame of a slot: applies the values that were set, writes those that changed,
/// records copies of new textures. The host calls it in every frame before
/// revmap_renderer_record(). This function neither submits nor waits.
///
/// The frame may be recorded once, several times or never, and its commands may be dropped: copies of
/// a texture are recorded in every prepared frame until one of these frames has run. A call that
/// fails records nothing, and the values that were set stay set: the next call tries them again.
///
/// The command buffer is recording, outside of a pass, for a queue of the device's family. Commands
/// of revmap_renderer_record() and revmap_renderer_record_compute() for earlier frames of this slot
/// have run, or are never submitted; those of earlier calls of this function may also be in
/// command_buffer. Command buffers of prepared frames are submitted to one queue, in the order of
/// this call.
///
/// Fails with REVMAP_RESULT_CONTENT for an object that cannot be drawn, until it is set right or
/// removed. The text begins with the object's number.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn revmap_renderer_prepare(
    renderer: *mut RevmapRenderer,
    command_buffer: vk::CommandBuffer,
    slot: u32,
    view: *const RevmapView,
) -> RevmapResult {
    enter(|| {
        let view = read(view)?.view()?;
        with(renderer, |r| r.prepare(command_buffer, slot, &view))
    })
}

/// Ends a frame of all views: the motion of the next frame is that from the present values. The
/// host calls it before the next frame's changes. Objects that were added since the last call begin
/// without motion. Renderers without REVMAP_ATTACHMENT_MOTION need no call.
#[unsafe(no_mangle)]
pub extern "C" fn revmap_renderer_end_frame(renderer: *mut RevmapRenderer) -> RevmapResult {
    enter_with(renderer, |r| {
        r.renderer.end_frame();
        Ok(())
    })
}

/// Prepares the frame like revmap_renderer_prepare(), seen by a camera in pictures of width *
/// height pixels. Depth is 0 at near and 1 at far, both along the view, and near cuts solids. The
/// output's depth order is REVMAP_DEPTH_ORDER_NORMAL.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn revmap_renderer_prepare_camera(
    renderer: *mut RevmapRenderer,
    command_buffer: vk::CommandBuffer,
    slot: u32,
    camera: *const RevmapCamera,
    width: u32,
    height: u32,
    near: f64,
    far: f64,
) -> RevmapResult {
    enter(|| {
        let view = View::from_camera(&read(camera)?.camera(), (width, height), [near, far])?;
        with(renderer, |r| r.prepare(command_buffer, slot, &view))
    })
}

/// Records the draws of the frame that was prepared for a slot. The function binds pipelines,
/// descriptor sets 0 to 2 and an index buffer. It sets neither viewport nor scissor, which are
/// dynamic.
///
/// The command buffer is recording, within a pass that is compatible with the output, with the
/// view's viewport and a scissor set. The renderer lives, and the slot is not prepared again, until
/// the commands have run.
///
/// Fails with REVMAP_RESULT_USAGE, and records nothing, if the slot is not prepared. Values set
/// since then are not drawn yet.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn revmap_renderer_record(
    renderer: *mut RevmapRenderer,
    command_buffer: vk::CommandBuffer,
    slot: u32,
) -> RevmapResult {
    enter_with(renderer, |r| {
        let frame = r.frame(command_buffer, slot)?;
        if !r.in_pass {
            let message = "this renderer computes; call revmap_renderer_record_compute";
            return Err(Fault::usage(message));
        }
        // SAFETY: the slot was prepared; the rest the caller has promised.
        Ok(unsafe { r.renderer.record(command_buffer, frame) }?)
    })
}

/// Records the dispatches of the frame that was prepared for a slot, into a target that was
/// cleared. The function records barriers between its own dispatches, none before its first and
/// none after its last write.
///
/// The command buffer is recording, outside of a pass; writes to the target before are made
/// available to compute shaders. The renderer lives, and the slot is not prepared again, until the
/// commands have run.
///
/// Fails like revmap_renderer_record().
#[unsafe(no_mangle)]
pub unsafe extern "C" fn revmap_renderer_record_compute(
    renderer: *mut RevmapRenderer,
    command_buffer: vk::CommandBuffer,
    slot: u32,
) -> RevmapResult {
    enter_with(renderer, |r| {
        let frame = r.frame(command_buffer, slot)?;
        if r.in_pass {
            let message = "this renderer draws in a pass; call revmap_renderer_record";
            return Err(Fault::usage(message));
        }
        // SAFETY: the slot was prepared; the rest the caller has promised.
        Ok(unsafe { r.renderer.record_compute(command_buffer, frame) }?)
    })
}

/// Pipelines that a renderer may come to need.
pub struct RevmapPrewarm;
handle!(RevmapPrewarm, "prewarm", Arc<Prewarm>);

/// Lists the general form of every pipeline that the objects may need. Once these are compiled,
/// revmap_renderer_prepare() compiles and hides nothing while parameters, lights, masks, placements,
/// the view, and the numbers of objects and copies change. Other techniques make others necessary:
/// textures where there were none, replicas, shadows. Nothing is compiled yet.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn revmap_renderer_prewarm(
    renderer: *mut RevmapRenderer,
    prewarm: *mut *mut RevmapPrewarm,
) -> RevmapResult {
    create(prewarm, || with(renderer, |r| Ok(r.renderer.prewarm()?)))
}

/// Lists the pipelines that would draw the frames of all slots faster. Once they are compiled, the next
/// revmap_renderer_prepare() takes them. The list is empty once nothing is faster.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn revmap_renderer_special_forms(
    renderer: *mut RevmapRenderer,
    prewarm: *mut *mut RevmapPrewarm,
) -> RevmapResult {
    create(prewarm, || {
        with(renderer, |r| Ok(r.renderer.special_forms()))
    })
}

/// Compiles those that are not compiled yet. Another thread may use the renderer meanwhile, or
/// destroy it.
#[unsafe(no_mangle)]
pub extern "C" fn revmap_prewarm_compile(prewarm: *const RevmapPrewarm) -> RevmapResult {
    enter(|| Ok(RevmapPrewarm::get(prewarm)?.compile()?))
}

/// Returns the number of pipelines, compiled or not.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn revmap_prewarm_count(
    prewarm: *const RevmapPrewarm,
    count: *mut usize,
) -> RevmapResult {
    put(count, "count", || Ok(RevmapPrewarm::get(prewarm)?.len()))
}

/// Destroys the list; null is none. Compiled pipelines stay.
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
#[unsafe(no_mangle)]
pub unsafe extern "C" fn revmap_renderer_record_prewarm(
    renderer: *mut RevmapRenderer,
    command_buffer: vk::CommandBuffer,
    slot: u32,
) -> RevmapResult {
    enter_with(renderer, |r| {
        let frame = r.frame(command_buffer, slot)?;
        // SAFETY: the slot was prepared; the rest the caller has promised.
        Ok(unsafe { r.renderer.record_prewarm(command_buffer, frame) }?)
    })
}
