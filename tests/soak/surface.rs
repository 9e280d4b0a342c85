//! The memory that a slot's frame is drawn into, read by the host afterwards.

use crate::common::host::{Attachments, Host, HostBuffer, barrier};
use crate::kind::Kind;
use crate::log::Finding;
use crate::views::Seen;
use ash::vk;
use revmap::gpu::{ComputeTarget, PreparedFrame, Renderer};

/// The attachments of a pass, or the bytes that a target of compute is copied to.
pub enum Surface<'a> {
    Pass(Box<Attachments<'a>>),
    Words(HostBuffer<'a>),
}

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

/// The packed colour behind everything in compute.
const BACKGROUND: u32 = 0xff40_3020;

impl<'a> Surface<'a> {
    pub fn new(host: &'a Host, kind: &Kind) -> Self {
        if kind.compute {
            let usage = vk::BufferUsageFlags::TRANSFER_DST;
            return Self::Words(HostBuffer::new(host, 8 * kind.pixels(), usage).unwrap());
        }
        Self::Pass(Box::new(
            Attachments::new(host, kind.options, &kind.formats).unwrap(),
        ))
    }

    /// The render pass; null without one.
    pub fn pass(&self) -> vk::RenderPass {
        match self {
            Self::Pass(into) => into.pass,
            Self::Words(_) => vk::RenderPass::null(),
        }
    }

    /// Records a frame, cleared before, and its copies to the host.
    ///
    /// # Safety
    /// `cmd` is recording outside of a pass; all that it reads lives until it has run.
    pub unsafe fn draw(
        &self,
        host: &Host,
        cmd: vk::CommandBuffer,
        (kind, seen): (&Kind, &Seen),
        words: Option<&HostBuffer<'_>>,
        recording: &Recording<'_>,
    ) -> Result<(), Finding> {
        // SAFETY: as the caller promised.
        unsafe {
            match (self, words) {
                (Self::Pass(into), _) => {
                    into.draw(cmd, &kind.clears(), false, || {
                        recording.warm(cmd)?;
                        host.device.cmd_set_viewport(cmd, 0, &[seen.viewport]);
                        host.device.cmd_set_scissor(cmd, 0, &[seen.scissor]);
                        recording.record(|r, frame| r.record(cmd, frame), || ())
                    })?;
                    into.copy(cmd);
                }
                (Self::Words(read), Some(words)) => {
                    let (raw, half) = (&host.device, 4 * kind.pixels() as u64);
                    barrier(host, cmd, &[]);
                    raw.cmd_fill_buffer(cmd, words.raw, 0, half, 1f32.to_bits());
                    raw.cmd_fill_buffer(cmd, words.raw, half, half, BACKGROUND);
                    let wait = || barrier(host, cmd, &[]);
                    wait();
                    recording.warm(cmd)?;
                    recording.record(|r, frame| r.record_compute(cmd, frame), wait)?;
                    wait();
                    let all = [vk::BufferCopy::default().size(2 * half)];
                    raw.cmd_copy_buffer(cmd, words.raw, read.raw, &all);
                    wait();
                }
                _ => panic!("compute without a target"),
            }
        }
        Ok(())
    }

    /// The bytes of all planes, once the commands have run.
    pub fn read(&self, kind: &Kind) -> Vec<Vec<u8>> {
        match self {
            Self::Words(read) => vec![read.bytes()],
            Self::Pass(into) => {
                let colors = (0..kind.formats.len()).map(|n| into.color(n));
                let depths = (kind.options.samples == 1).then(|| into.depths());
                let depths = depths.map(|all| bytemuck::cast_slice(&all).to_vec());
                colors.chain(depths).collect()
            }
        }
    }
}

impl Recording<'_> {
    /// # Safety
    /// `cmd` is recording where the frame may be recorded.
    unsafe fn warm(&self, cmd: vk::CommandBuffer) -> revmap::Result<()> {
        match self.warms {
            // SAFETY: as the caller promised.
            true => unsafe { self.renderer.record_prewarm(cmd, self.frame) },
            false => Ok(()),
        }
    }

    fn record(
        &self,
        record: impl Fn(&Renderer, &PreparedFrame) -> revmap::Result<()>,
        between: impl Fn(),
    ) -> Result<(), Finding> {
        for frame in &self.refused {
            match record(self.renderer, frame) {
                Err(e) if e.kind == revmap::error::ErrorKind::Usage => {}
                other => return Err(Finding(format!("an old token was recorded: {other:?}"))),
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

/// A buffer that compute draws into.
pub fn words<'a>(host: &'a Host, kind: &Kind) -> HostBuffer<'a> {
    use vk::BufferUsageFlags as U;
    let usage = U::STORAGE_BUFFER | U::TRANSFER_SRC | U::TRANSFER_DST;
    HostBuffer::new(host, 8 * kind.pixels(), usage).unwrap()
}

/// The same as a target.
pub fn target(words: &HostBuffer<'_>, depths: bool) -> ComputeTarget {
    ComputeTarget {
        words: words.raw,
        images: Vec::new(),
        depths,
    }
}
