//! The draws of a frame off screen, and their times.

use super::Offscreen;
use crate::error::Result;
use crate::settings::DrawStage;
use ash::vk;
use std::time::Instant;

/// The times of one frame.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Times {
    /// Milliseconds that the CPU took to apply changes and to record.
    pub prepare_ms: f64,
    /// Milliseconds between GPU timestamps around the work; `None` if the device has no timestamps.
    pub gpu_ms: Option<f64>,
    /// Milliseconds from submission to completion by the wall clock.
    pub frame_ms: f64,
}

/// Other content that is drawn in an off-screen frame's pass, into the same depth buffer.
pub trait Guest {
    /// Records work that the draws need beforehand, such as copies into buffers. The times leave it
    /// out.
    ///
    /// # Safety
    /// `cmd` is recording, outside of a pass. All recorded commands must stay valid until the frame
    /// was drawn.
    unsafe fn prepare(&self, _cmd: vk::CommandBuffer) {}

    /// Records the guest's draws.
    ///
    /// # Safety
    /// `cmd` is recording, within the pass of [`Offscreen::render_pass`], with viewport and scissor
    /// set. All recorded commands must stay valid until the frame was drawn.
    unsafe fn record(&self, cmd: vk::CommandBuffer);
}

impl Offscreen {
    /// Compiles every pipeline that updates may need while no object's technique changes, as
    /// [`Renderer::prewarm`](crate::gpu::Renderer::prewarm) does. Then runs each pipeline on
    /// nothing, because some drivers compile only then: see
    /// [`Renderer::record_prewarm`](crate::gpu::Renderer::record_prewarm).
    ///
    /// # Errors
    /// Errors of Vulkan calls; [`Usage`](crate::error::ErrorKind::Usage) after an update that failed half
    /// way.
    pub fn prewarm(&mut self) -> Result<()> {
        self.check_whole()?;
        self.renderer.prewarm()?.compile()?;
        let compute = self.settings.stage == DrawStage::Compute;
        let Self {
            renderer, target, ..
        } = self;
        self.commands.record(|cmd| {
            // SAFETY: as in `draw_with`.
            unsafe {
                let frame = renderer.prepare(cmd, 0, &self.view)?;
                target.clear(cmd, self.background, frame.reads_depths());
                if compute {
                    return renderer.record_prewarm(cmd, &frame);
                }
                target.begin(cmd, self.pass, self.background);
                renderer.record_prewarm(cmd, &frame)?;
                self.device.raw.cmd_end_render_pass(cmd);
            }
            Ok(())
        })?;
        self.commands.submit_and_wait()
    }

    /// Draws one frame and waits for it.
    ///
    /// # Errors
    /// Errors of Vulkan calls; [`Usage`](crate::error::ErrorKind::Usage) after an update that failed half
    /// way.
    pub fn draw(&mut self) -> Result<Times> {
        self.draw_with(None)
    }

    /// Draws one frame with a guest in the same pass, after all objects, and waits for it. Compute
    /// has no pass and does not call the guest.
    ///
    /// # Errors
    /// Same as [`Offscreen::draw`].
    pub fn draw_with(&mut self, guest: Option<&dyn Guest>) -> Result<Times> {
        self.check_whole()?;
        let start = Instant::now();
        let Self {
            renderer,
            target,
            commands,
            clock,
            view,
            background,
            ..
        } = self;
        let (compute, pass) = (self.settings.stage == DrawStage::Compute, self.pass);
        commands.record(|cmd| {
            // SAFETY: `cmd` is recording, and the previous frame was waited for.
            let frame = unsafe { renderer.prepare(cmd, 0, view)? };
            if let (Some(guest), false) = (guest, compute) {
                // SAFETY: `cmd` is recording outside of a pass, and is waited for before this
                // returns.
                unsafe { guest.prepare(cmd) };
            }
            clock.start(cmd);
            target.clear(cmd, *background, frame.reads_depths());
            // SAFETY: the frame was prepared above; the target was cleared, the pass has the
            // output's formats and sets viewport and scissor; the commands are waited for before
            // anything is dropped.
            unsafe {
                if compute {
                    renderer.record_compute(cmd, &frame)?;
                } else {
                    target.begin(cmd, pass, *background);
                    renderer.record(cmd, &frame)?;
                    if let Some(guest) = guest {
                        guest.record(cmd);
                    }
                    self.device.raw.cmd_end_render_pass(cmd);
                }
            }
            clock.stop(cmd);
            Ok(())
        })?;
        let prepare_ms = start.elapsed().as_secs_f64() * 1e3;
        let start = Instant::now();
        self.commands.submit_and_wait()?;
        let frame_ms = start.elapsed().as_secs_f64() * 1e3;
        Ok(Times {
            prepare_ms,
            gpu_ms: self.clock.milliseconds()?,
            frame_ms,
        })
    }
}
