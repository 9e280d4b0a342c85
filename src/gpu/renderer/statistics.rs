//! The commands and bytes of a prepared frame, and what it cost the CPU.

use super::slot::FrameSlot;
use crate::plan::{Call, DrawPath};

/// The commands and bytes of a prepared frame, and what it cost the CPU.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct FrameStatistics {
    /// Objects of which a part may show.
    pub objects: u32,
    /// Draws, those of one indirect command counted one by one.
    pub draws: u32,
    /// Dispatches.
    pub dispatches: u32,
    /// Groups of draws, or dispatches, that are left out because their pipeline is not compiled
    /// (`Renderer::hide_until_compiled`).
    pub hidden: u32,
    /// Tiles of fragments, and work groups of dispatches whose number the host knows.
    pub tiles: u32,
    /// Bytes of the slot's buffers.
    pub slot_bytes: u64,
    /// CPU time of [`Renderer::prepare`](crate::gpu::Renderer::prepare), milliseconds of the clock:
    /// of everything from the values that were set to the copies of textures.
    pub prepare_ms: f64,
    /// CPU time of the last [`Renderer::record`](crate::gpu::Renderer::record) or
    /// [`record_compute`](crate::gpu::Renderer::record_compute) of the frame, milliseconds; 0
    /// before.
    pub record_ms: f64,
}

impl FrameSlot {
    pub fn statistics(&self) -> FrameStatistics {
        let Some(bound) = &self.bound else {
            return FrameStatistics::default();
        };
        let frame = &bound.plan.frame;
        let paths = frame.paths.iter();
        let mut all = FrameStatistics {
            objects: paths.filter(|p| **p != DrawPath::Nothing).count() as u32,
            hidden: bound.hidden() as u32,
            slot_bytes: self.bytes(),
            ..FrameStatistics::default()
        };
        let steps = frame.steps.iter().zip(&bound.steps);
        for (step, _) in steps.filter(|(_, bound)| bound.pipeline.is_some()) {
            match &step.call {
                Call::Draws(range) => all.draws += range.end - range.start,
                Call::Walk(points, _) => {
                    all.draws += 1;
                    all.tiles += points.len() as u32;
                }
                Call::Groups(groups, _) => {
                    all.dispatches += 1;
                    all.tiles += groups;
                }
                Call::Indirect(..) => all.dispatches += 1,
            }
        }
        all
    }
}
