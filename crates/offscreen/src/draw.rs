//! The draws of a frame off screen, and their times.

use crate::commands::Times;
use crate::offscreen::Offscreen;
use ash::vk;
use revmap::error::Result;
use revmap::gpu::{PreparedFrame, Renderer, View};
use std::ops::Range;

/// Other content that is drawn in an off-screen frame's passes, into the same depth buffer. A frame
/// has one pass, or one for each of its submissions ([`Times::submissions`]).
pub trait Guest {
    /// Records work that the draws need beforehand, such as copies into buffers: once for each frame.
    /// The times leave it out.
    ///
    /// # Safety
    /// `cmd` is recording, outside of a pass. All recorded commands must stay valid until the frame
    /// was drawn.
    unsafe fn prepare(&self, _cmd: vk::CommandBuffer) {}

    /// Records passes that the draws need, such as shadow maps: once for each frame, within its times.
    ///
    /// # Safety
    /// As [`Guest::prepare`].
    unsafe fn record_before(&self, _cmd: vk::CommandBuffer) {}

    /// Records the guest's draws: once for each submission of a frame, which draws the rows of the
    /// scissor.
    ///
    /// # Safety
    /// `cmd` is recording, within a pass that is compatible with [`Offscreen::render_pass`], with
    /// viewport and scissor set. The scissor is the render area and must stay. All recorded commands
    /// must stay valid until the frame was drawn.
    unsafe fn record(&self, cmd: vk::CommandBuffer);
}

impl Offscreen {
    /// Compiles the pipelines of the present frame, and keeps compilation out of the times from now
    /// on: a frame that needs other pipelines is drawn twice, and the second time counts. Some
    /// drivers, including all software drivers, compile shaders at the first draw.
    ///
    /// # Errors
    /// Errors of Vulkan calls; [`Usage`](revmap::error::ErrorKind::Usage) after an update that failed
    /// half way.
    pub fn prewarm(&mut self) -> Result<()> {
        self.warm = true;
        self.draw()?;
        Ok(())
    }

    /// Draws one frame and waits for it.
    ///
    /// # Errors
    /// Errors of Vulkan calls; [`Usage`](revmap::error::ErrorKind::Usage) after an update that failed
    /// half way.
    pub fn draw(&mut self) -> Result<Times> {
        self.draw_with(None)
    }

    /// Draws one frame with a guest in the same passes, after all objects, and waits for it. Compute
    /// has no pass and does not call the guest.
    ///
    /// # Errors
    /// Same as [`Offscreen::draw`].
    pub fn draw_with(&mut self, guest: Option<&dyn Guest>) -> Result<Times> {
        self.check_whole()?;
        let size = [self.settings.width, self.settings.height];
        let (mut row, mut all) = (0, Times::default());
        while row < size[1] {
            let rows = self.bands.next(row, size);
            row = rows.end;
            let compiled = self.device.pipelines_compiled();
            let mut times = self.draw_rows(guest, &rows)?;
            // Later bands would draw over what they have drawn.
            let again = self.warm && rows.start == 0;
            if again && self.device.pipelines_compiled() != compiled {
                times = self.draw_rows(guest, &rows)?;
            }
            // The clock of the device leaves out the work of others.
            let ms = times.gpu_ms.unwrap_or(times.frame_ms);
            self.bands.record(&rows, ms, row == size[1]);
            all.add(Times {
                submissions: 1,
                ..times
            });
        }
        if all.submissions > 1 {
            // Draw paths and costs are those of the whole frame.
            self.renderer.plan(&self.view)?;
        }
        Ok(all)
    }

    /// Draws rows of a frame in one submission, and waits for it.
    fn draw_rows(&mut self, guest: Option<&dyn Guest>, rows: &Range<u32>) -> Result<Times> {
        let (renderer, target, commands) = (&mut self.renderer, &self.target, &self.commands);
        let background = self.scene.background;
        let begins = rows.start == 0;
        let whole = begins && rows.end == self.settings.height;
        let view = match whole {
            true => self.view,
            false => self.view.with_rows(rows.clone()),
        };
        let compute = target.is_compute();
        let times = commands.run(|cmd| {
            // SAFETY: `cmd` is recording, and the previous submission was waited for.
            let frame = unsafe { prepare(renderer, cmd, &view)? };
            if let (Some(guest), true, false) = (guest, begins, compute) {
                // SAFETY: `cmd` is recording outside of a pass, and is waited for before this
                // returns.
                unsafe { guest.prepare(cmd) };
            }
            commands.start_clock(cmd);
            if let (Some(guest), true, false) = (guest, begins, compute) {
                // SAFETY: as above.
                unsafe { guest.record_before(cmd) };
            }
            if begins {
                target.clear(cmd, background, !whole || frame.reads_depths());
            } else {
                target.wait(cmd);
            }
            // SAFETY: the frame was prepared above; the target was cleared, the pass has the
            // output's formats and sets viewport and scissor; the commands are waited for before
            // anything is dropped.
            unsafe {
                if compute {
                    renderer.record_compute(cmd, &frame)?;
                } else {
                    target.begin(cmd, background, rows);
                    renderer.record(cmd, &frame)?;
                    if let Some(guest) = guest {
                        guest.record(cmd);
                    }
                    self.device.raw().cmd_end_render_pass(cmd);
                }
            }
            commands.stop_clock(cmd);
            Ok(())
        })?;
        let gpu_ms = commands.gpu_ms()?;
        Ok(Times { gpu_ms, ..times })
    }
}

/// Prepares a frame by the special forms of all pipelines, compiled now if they are new. General
/// forms would only be in the way: off screen nothing waits for a frame.
///
/// # Safety
/// The duties of [`Renderer::prepare`], for the first slot.
unsafe fn prepare(
    renderer: &mut Renderer,
    cmd: vk::CommandBuffer,
    view: &View,
) -> Result<PreparedFrame> {
    renderer.hide_until_compiled(true);
    // SAFETY: as the caller promised.
    let mut frame = unsafe { renderer.prepare(cmd, 0, view) };
    let special = renderer.special_forms();
    if frame.is_ok() && !special.is_empty() {
        let compiled = special.compile();
        // SAFETY: as the caller promised; nothing of the first frame is recorded.
        frame = compiled.and_then(|()| unsafe { renderer.prepare(cmd, 0, view) });
    }
    renderer.hide_until_compiled(false);
    frame
}
