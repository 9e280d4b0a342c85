//! What a frame needs before it can be recorded: plans, blocks, lists, copies. The cost follows
//! what has changed.

use super::block::{frame_block, instance_block};
use super::blocks::SolidBlock;
use super::output::Output;
use super::plan::Work;
use super::renderer::Renderer;
use super::view::View;
use crate::error::{Error, Result, Stage};
use crate::scene::Shadow;
use crate::settings::Planes;
use ash::vk;

impl Renderer {
    /// Prepares the frame of slot `slot`, seen by `view`: takes over what was set, writes what
    /// changed, records copies of new textures. To be called outside of a render pass, before
    /// [`Renderer::record`].
    ///
    /// # Errors
    /// [`Stage::Scene`] or [`Stage::Profile`](crate::error::Stage) for what cannot be drawn, with
    /// the key `object.N...`, N counted in order: everything stays as it was before it was set.
    /// [`Stage::Usage`] for a slot that is not there or a view of the other depth order.
    /// [`Stage::Draw`] of Vulkan.
    ///
    /// # Safety
    /// This call writes to memory that the frame before in `slot` read; records image copies and
    /// their barriers into `cmd`; drops what no frame in flight reads any more.
    ///
    /// The caller must see to it that
    /// * `cmd` is recording, outside of a render pass, for a queue of the device's family;
    /// * the commands recorded for `slot` before have run, or were never submitted;
    /// * commands of other slots that were recorded before are submitted before these.
    pub unsafe fn prepare(
        &mut self,
        cmd: vk::CommandBuffer,
        slot: usize,
        view: &View,
    ) -> Result<()> {
        self.check(slot, view)?;
        self.frame += 1;
        let done = |r: &(u64, _)| r.0 < self.frame;
        let count = self.retired.iter().take_while(|r| done(r)).count();
        self.retired.drain(..count);
        self.refresh(Some(view))?;
        self.plan(view)?;
        let staging = self.uploads.record(&self.device, cmd);
        if !staging.is_empty() {
            self.retire(staging);
        }
        self.write(slot, view)
    }

    fn check(&self, slot: usize, view: &View) -> Result<()> {
        let usage = |message: String| Err(Error::new(Stage::Usage, message));
        if slot >= self.frames.len() {
            return usage(format!(
                "frame slot {slot}; there are {}",
                self.frames.len()
            ));
        }
        if view.order != self.output.depth_order() {
            return usage("the view's depth order is not the output's; give both the same".into());
        }
        let parallel = self.output.planes() == Planes::Depth { parallel: true };
        if view.parallel != parallel {
            return usage(
                "parallel views go with an output of parallel depths, and no others".into(),
            );
        }
        if matches!(self.output, Output::Compute(_)) && self.target.is_none() {
            return usage("compute has no target yet; give one to set_compute_target".into());
        }
        Ok(())
    }

    /// Writes what of a slot is older than the renderer.
    fn write(&mut self, slot: usize, view: &View) -> Result<()> {
        let frame = frame_block(view, &self.lighting);
        let blocks = u32::try_from(self.entries.len()).unwrap_or(u32::MAX) + self.lists.2;
        let instances = self.instances.initial_range().end;
        let slots = &mut self.frames;
        let to = &mut slots[slot];
        to.fit(blocks, instances)?;
        to.write_frame(&frame)?;
        let bit = 1u32 << slot;
        let casts = self.lighting.shadow != Shadow::Off;
        let mut stale = std::mem::take(&mut to.stale);
        if std::mem::take(&mut to.empty) {
            stale.clone_from(&self.order);
        }
        for number in stale {
            let Some(entry) = &mut self.entries[number as usize] else {
                continue;
            };
            entry.stale &= !bit;
            let Some(mut block) = entry.block(&self.settings) else {
                continue;
            };
            let placements = entry.drawn().placements();
            if let Some(copy) = placements.first() {
                block.single = instance_block(entry.drawn(), copy, view);
            }
            to.write_block(number, &block)?;
            let mut write = |copy: u32| {
                let of =
                    |copy: u32| instance_block(entry.drawn(), &placements[copy as usize], view);
                let block = if copy == 0 { block.single } else { of(copy) };
                to.write_instance(entry.instances.start + copy, &block)
            };
            match &entry.draw.work {
                // Nothing reads the others, unless they may throw a shadow.
                Some(Work::Bins(shown)) if !casts => {
                    shown.copies.iter().try_for_each(|&copy| write(copy))?
                }
                _ => (0..entry.instances.end - entry.instances.start).try_for_each(write)?,
            }
        }
        if self.listed[slot] != self.version {
            if casts {
                let all: Vec<SolidBlock> = self
                    .order
                    .iter()
                    .filter_map(|&n| self.entries[n as usize].as_ref()?.block(&self.settings))
                    .collect();
                to.write_shadows(&all)?;
            }
            let (words, tiles, _) = &self.lists;
            to.write_lists(words, words.len() + tiles)?;
            if matches!(self.output, Output::Compute(_)) {
                for &number in &self.order {
                    let Some(entry) = &self.entries[number as usize] else {
                        continue;
                    };
                    if let (Some(Work::Beams { copies, .. }), Some(mut block)) =
                        (&entry.draw.work, entry.block(&self.settings))
                    {
                        for tiles in copies {
                            let Some(number) = tiles.block else { continue };
                            let copy = &entry.drawn().placements()[tiles.instance];
                            block.single = instance_block(entry.drawn(), copy, view);
                            to.write_block(number, &block)?;
                        }
                    }
                }
            }
            self.listed[slot] = self.version;
        }
        let target = self.target.as_ref().map(|(t, n)| (t, *n));
        to.name((&self.arena.buffer, self.arena.generation), target);
        Ok(())
    }
}
