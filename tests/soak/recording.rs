//! The recording of a prepared frame.

use crate::common::host::{Canvas, Host, barrier};
use crate::log::{Finding, found};
use crate::views::Seen;
use ash::vk;
use revmap::error::ErrorKind;
use revmap::gpu::{PreparedFrame, Renderer};

/// The recording of a prepared frame, after tokens that must be refused.
pub struct Recording<'a> {
    pub renderer: &'a Renderer,
    pub frame: &'a PreparedFrame,
    pub times: usize,
    /// True if draws of nothing are recorded with all pipelines first.
    pub warms: bool,
    /// Tokens of other frames.
    pub refused: Vec<&'a PreparedFrame>,
}

impl Recording<'_> {
    /// Records the frame into a cleared canvas, and its copies to the host.
    ///
    /// # Safety
    /// `cmd` is recording outside of a pass; all that it reads lives until it has run.
    pub unsafe fn draw(
        &self,
        host: &Host,
        cmd: vk::CommandBuffer,
        canvas: &Canvas<'_>,
        seen: &Seen,
    ) -> Result<(), Finding> {
        // SAFETY: as the caller promised.
        unsafe {
            canvas.record(cmd, || {
                if self.warms {
                    self.renderer.record_prewarm(cmd, self.frame)?;
                }
                if let Canvas::Pass(_) = canvas {
                    host.device.cmd_set_viewport(cmd, 0, &[seen.viewport]);
                    host.device.cmd_set_scissor(cmd, 0, &[seen.scissor]);
                    return self.record(|r, frame| r.record(cmd, frame), || ());
                }
                let wait = || barrier(host, cmd, &[]);
                self.record(|r, frame| r.record_compute(cmd, frame), wait)
            })?;
            canvas.copy(cmd);
        }
        Ok(())
    }

    fn record(
        &self,
        record: impl Fn(&Renderer, &PreparedFrame) -> revmap::Result<()>,
        between: impl Fn(),
    ) -> Result<(), Finding> {
        for frame in &self.refused {
            match record(self.renderer, frame) {
                Err(e) if e.kind == ErrorKind::Usage => {}
                other => return found(format!("an old token was recorded: {other:?}")),
            }
        }
        for time in 0..self.times {
            if time > 0 {
                between();
            }
            record(self.renderer, self.frame)?;
        }
        Ok(())
    }
}
