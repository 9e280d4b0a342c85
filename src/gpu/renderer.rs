//! Objects on a device, ready to be recorded into any command buffer.
//!
//! Objects come and go in `objects.rs`; what follows from their new values is in `refresh.rs`. A
//! frame is planned in `frame_plan.rs`, prepared in `prepare.rs`, recorded in `record.rs`.

use super::arena::TableArena;
use super::buffers::indices;
use super::device::{Device, Shared};
use super::entry::{Entry, ObjectId};
use super::frame_slot::FrameSlot;
use super::memory::Buffer;
use super::output::Output;
use super::plan::{DrawPath, Work};
use super::solid::SolidCache;
use super::target::ComputeTarget;
use super::textures::{ShadowMaps, Textures};
use super::uploads::Uploads;
use super::view::View;
use crate::error::{Error, Result, Stage};
use crate::scene::{Lighting, Object};
use crate::settings::{Planes, SearchSettings, Solver};
use crate::shader::Met;
use range_alloc::RangeAllocator;
use std::any::Any;
use std::collections::VecDeque;
use std::ops::Range;
use std::sync::Arc;

/// Objects on a device, drawn into whatever the host draws into.
///
/// A frame is prepared, then recorded, with the number of its **slot**: frames in flight take turns
/// in `frames` slots.
///
/// ```text
/// renderer.set_placement(pawn, there)?;                  // any number of changes
/// renderer.prepare(cmd, slot, &view)?;                   // outside of a render pass
/// begin_rendering(cmd); renderer.record(cmd, slot); ..   // inside
/// ```
///
/// Neither submits, waits or compiles a pipeline that was prewarmed; memory is allocated while
/// buffers still grow. A renderer must live until the frames that it recorded are done.
pub struct Renderer {
    pub(super) frames: Vec<FrameSlot>,
    pub(super) entries: Vec<Option<Entry>>,
    /// Numbers of entries in the order in which they were added.
    pub(super) order: Vec<u32>,
    pub(super) generations: Vec<u32>,
    pub(super) solids: SolidCache,
    pub(super) textures: Textures,
    pub(super) shadow_maps: Arc<ShadowMaps>,
    pub(super) uploads: Uploads,
    pub(super) arena: TableArena,
    /// Corners of a hull's triangles, the same for every hull.
    pub(super) corners: Buffer,
    pub(super) lighting: Lighting,
    /// Entries whose values differ from what is prepared of them.
    pub(super) changed: Vec<u32>,
    /// Entries that must be planned anew.
    pub(super) unplanned: Vec<u32>,
    /// Whether every entry is drawn by the fallback, as one has no surface and shadows meet all by
    /// one search.
    pub(super) all_fall_back: bool,
    /// What shadows' rays may meet.
    pub(super) met: Met,
    pub(super) view: Option<View>,
    /// Instances of all entries, those free among them.
    pub(super) instances: RangeAllocator<u32>,
    /// Counts what changes in a way that compute's lists depend on.
    pub(super) version: u64,
    /// The version that each slot's lists are of.
    pub(super) listed: Vec<u64>,
    /// Words of all bins; in compute: words of the lists behind them, blocks of single copies.
    pub(super) lists: (Vec<u32>, usize, u32),
    /// In compute, and where every plane is drawn: what shaders write to, and how often it was set.
    pub(super) target: Option<(ComputeTarget, u64)>,
    /// Whether compute leaves the depths of all pixels, also of one object alone.
    pub(super) keeps_depths: bool,
    /// What frames in flight may still read, with the frame after which none does.
    pub(super) retired: VecDeque<(u64, Box<dyn Any + Send>)>,
    /// Frames prepared so far.
    pub(super) frame: u64,
    pub(super) rebuilds: u64,
    pub(super) notes: Vec<String>,
    pub(super) settings: SearchSettings,
    pub(super) output: Output,
    /// Of its pipelines, where they are not shared.
    pub(super) owner: u64,
    pub(super) device: Arc<Shared>,
}

/// Most frames in flight.
const MOST_FRAMES: usize = 8;

impl Renderer {
    /// A renderer without objects, for one output, with `frames` frames in flight (1 to 8).
    ///
    /// # Errors
    /// [`Stage::Usage`] for another number of frames or samples; [`Stage::Draw`] of Vulkan.
    pub fn new(
        device: &Device,
        output: Output,
        settings: &SearchSettings,
        frames: usize,
    ) -> Result<Self> {
        let usage = |message: String| Error::new(Stage::Usage, message);
        if !(1..=MOST_FRAMES).contains(&frames) {
            return Err(usage(format!(
                "{frames} frames in flight; give 1 to {MOST_FRAMES}"
            )));
        }
        if let Output::Pass(pass) = &output
            && ![1, 2, 4, 8].contains(&pass.samples)
        {
            return Err(usage(format!(
                "{} samples; give 1, 2, 4 or 8",
                pass.samples
            )));
        }
        if matches!(output.planes(), Planes::Depth { .. }) {
            let exact = matches!(
                settings.solver,
                Solver::Hull | Solver::Quadric | Solver::Live
            );
            if !exact || matches!(output, Output::Compute(_)) {
                let message =
                    "depth alone is drawn in a pass, by hull, quadric or live; give one of them";
                return Err(usage(message.into()));
            }
        }
        let device = device.shared.clone();
        let mut uploads = Uploads::default();
        Ok(Self {
            frames: (0..frames)
                .map(|_| FrameSlot::new(&device))
                .collect::<Result<_>>()?,
            entries: Vec::new(),
            order: Vec::new(),
            generations: Vec::new(),
            solids: SolidCache::default(),
            textures: Textures::new(&device, &mut uploads, settings.map_format)?,
            shadow_maps: Arc::default(),
            uploads,
            arena: TableArena::new(&device)?,
            corners: indices(&device, 0)?,
            lighting: Lighting::default(),
            changed: Vec::new(),
            unplanned: Vec::new(),
            all_fall_back: false,
            met: Met::default(),
            view: None,
            instances: RangeAllocator::new(0..64),
            version: 1,
            listed: vec![0; frames],
            lists: (Vec::new(), 0, 0),
            target: None,
            keeps_depths: false,
            retired: VecDeque::new(),
            frame: 0,
            rebuilds: 0,
            notes: Vec::new(),
            settings: *settings,
            owner: device.pipelines()?.owner(&output),
            output,
            device,
        })
    }

    /// The values of an object, as set last.
    ///
    /// # Errors
    /// [`Stage::Usage`] for an object that is not there.
    pub fn object(&mut self, id: ObjectId) -> Result<&Object> {
        Ok(self.entry(id)?.latest())
    }

    /// What was done in another way than asked for, and why; each thing once.
    #[must_use]
    pub fn notes(&self) -> &[String] {
        &self.notes
    }

    /// How each object was drawn in the last prepared frame, in order.
    #[must_use]
    pub fn draw_paths(&self) -> Vec<DrawPath> {
        let path = |e: &Entry| e.draw.work.as_ref().map_or(DrawPath::Nothing, Work::path);
        self.ordered().map(path).collect()
    }

    /// How many surfaces were made: one for each profile under each offset that no object had in
    /// the frame before. A camera that moves makes those of levels that it asks for the first time;
    /// with [`Tolerance::EXACT`](crate::settings::Tolerance::EXACT) none. Searches on the map never
    /// do.
    #[must_use]
    pub fn rebuild_count(&self) -> u64 {
        self.rebuilds
    }

    /// Bytes that maps take on the device: shape maps with tables of lengths, and colour and
    /// displacement maps.
    #[must_use]
    pub fn map_bytes(&self) -> [u64; 2] {
        let mut seen = Vec::new();
        let mut shapes = 0;
        for prepared in self.ordered().filter_map(|e| e.prepared.as_ref()) {
            let images = [
                prepared.map.as_ref().map(|m| &m.texture),
                prepared.arc.as_ref().map(|a| &a.texture),
            ];
            for image in images.into_iter().flatten() {
                if !seen.contains(&Arc::as_ptr(image)) {
                    seen.push(Arc::as_ptr(image));
                    shapes += image.bytes();
                }
            }
        }
        [shapes, self.textures.bytes()]
    }

    pub(super) fn ordered(&self) -> impl Iterator<Item = &Entry> {
        self.order
            .iter()
            .filter_map(|&number| self.entries[number as usize].as_ref())
    }

    pub(super) fn entry(&mut self, id: ObjectId) -> Result<&mut Entry> {
        let known = self.generations.get(id.number as usize) == Some(&id.generation);
        self.entries
            .get_mut(id.number as usize)
            .and_then(Option::as_mut)
            .filter(|_| known)
            .ok_or_else(|| {
                Error::new(
                    Stage::Usage,
                    "the object was removed, or is another renderer's",
                )
            })
    }

    /// Sets what compute writes to, from the next prepared frame on.
    ///
    /// # Safety
    /// This call keeps the handles; [`Renderer::prepare`] binds them.
    ///
    /// The caller must see to it that
    /// * they are of this device, as [`ComputeTarget`] describes them, and large enough for every
    ///   view's viewport, which begins at 0;
    /// * they live until another target is set and the frames that were recorded before are done.
    pub unsafe fn set_compute_target(&mut self, target: ComputeTarget) {
        self.set_target(Some(target));
    }

    pub(super) fn set_target(&mut self, target: Option<ComputeTarget>) {
        let generation = self.target.as_ref().map_or(0, |t| t.1) + 1;
        self.target = target.map(|target| (target, generation));
    }

    /// Keeps something until no frame in flight can read it.
    pub(super) fn retire<T: Any + Send>(&mut self, thing: T) {
        let after = self.frame + self.frames.len() as u64;
        self.retired.push_back((after, Box::new(thing)));
    }

    /// Notes that every slot holds something older of an entry.
    pub(super) fn mark(&mut self, number: u32) {
        let Some(entry) = &mut self.entries[number as usize] else {
            return;
        };
        for (bit, slot) in self.frames.iter_mut().enumerate() {
            if entry.stale & (1 << bit) == 0 {
                entry.stale |= 1 << bit;
                slot.stale.push(number);
            }
        }
    }

    pub(super) fn allocate_instances(&mut self, count: usize) -> Result<Range<u32>> {
        let many = || Error::new(Stage::Draw, "more than 2^31 instances");
        let count = u32::try_from(count).map_err(|_| many())?;
        if let Ok(range) = self.instances.allocate_range(count) {
            return Ok(range);
        }
        let end = self.instances.initial_range().end;
        let bigger = end.checked_add(end.max(count)).filter(|e| *e < 1 << 31);
        self.instances.grow_to(bigger.ok_or_else(many)?);
        self.instances.allocate_range(count).map_err(|_| many())
    }

    pub(super) fn resize_instances(&mut self, id: ObjectId, count: usize) -> Result<()> {
        let old = self.entry(id)?.instances.clone();
        let new = self.swap_instances(old, count)?;
        self.entry(id)?.instances = new;
        self.changed.push(id.number);
        Ok(())
    }

    /// Another range of instances in place of `old`.
    pub(super) fn swap_instances(&mut self, old: Range<u32>, count: usize) -> Result<Range<u32>> {
        let new = self.allocate_instances(count)?;
        self.instances.free_range(old);
        Ok(new)
    }
}

impl Drop for Renderer {
    fn drop(&mut self) {
        if let Ok(pipelines) = self.device.pipelines() {
            pipelines.forget(self.owner);
        }
    }
}
