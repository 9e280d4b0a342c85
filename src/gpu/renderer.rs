//! Objects on a device, ready to be recorded into any command buffer.
//!
//! [`Renderer::prepare`] is in `prepare.rs`, [`Renderer::record`] in `record.rs`, what changes of
//! an object in `refresh.rs`.

use super::arena::TableArena;
use super::buffers::indices;
use super::device::{Device, Shared};
use super::frame_slot::FrameSlot;
use super::map_key::MapFacts;
use super::memory::Buffer;
use super::offset_surface::OffsetSurface;
use super::output::Output;
use super::plan::{DrawPath, Work};
use super::shape_texture::{ArcTexture, ShapeTexture};
use super::solid::{Solid, SolidCache};
use super::target::ComputeTarget;
use super::textures::{ShadowMaps, TextureSet, Textures};
use super::uploads::Uploads;
use super::view::View;
use crate::error::{Error, Result, Stage};
use crate::scene::{GrownObject, Lighting, Object, Offset, Placement};
use crate::settings::{Planes, SearchSettings, Solver};
use crate::shader::{Kind, LIST_LENGTHS, Met, Variant};
use ash::vk;
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
    generations: Vec<u32>,
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

/// An object of a renderer. It stays the same object whatever is set, and is never another's once
/// removed.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct ObjectId {
    number: u32,
    generation: u32,
}

impl ObjectId {
    /// The id as one number, never 0, for interfaces that carry plain numbers.
    #[must_use]
    pub const fn to_bits(self) -> u64 {
        (self.generation as u64) << 32 | (self.number as u64 + 1)
    }

    /// The id of [`ObjectId::to_bits`]. Any other number is the id of no object.
    #[must_use]
    #[allow(clippy::cast_possible_truncation)] // the two halves
    pub const fn from_bits(bits: u64) -> Self {
        Self {
            number: (bits as u32).wrapping_sub(1),
            generation: (bits >> 32) as u32,
        }
    }
}

/// One object.
pub(super) struct Entry {
    pub object: Object,
    /// What was set since it was prepared last.
    pub wanted: Option<Object>,
    /// What is drawn in its place, in a box that has grown with the offset.
    pub grown: Option<GrownObject>,
    /// None before the first frame, and where that failed.
    pub prepared: Option<Prepared>,
    pub draw: Draw,
    pub instances: Range<u32>,
    /// Bits of the slots that hold something older.
    pub stale: u32,
}

/// What follows from an object's values, whatever the view.
pub(super) struct Prepared {
    /// Kept, as the cache keeps nothing.
    pub solid: Arc<Solid>,
    /// Which level of the surface it is drawn by.
    pub level: u8,
    /// Surfaces of other levels that the view asked for before.
    pub levels: Vec<Arc<OffsetSurface>>,
    /// What it is drawn by, which is not always what was asked for.
    pub solver: Solver,
    /// What the search walks.
    pub surface: Option<Arc<OffsetSurface>>,
    /// What rays can be held to before they are searched.
    pub wrapped: Option<Arc<OffsetSurface>>,
    pub map: Option<Arc<ShapeTexture>>,
    pub facts: MapFacts,
    pub arc: Option<Arc<ArcTexture>>,
    /// Its map's number among those that shadows read.
    pub shadow_map: u32,
    pub textures: Arc<TextureSet>,
    pub variant: Variant,
}

/// What follows from the view, too.
#[derive(Default)]
pub(super) struct Draw {
    pub work: Option<Work>,
    pub pipeline: vk::Pipeline,
    /// The pipeline that lists tiles, where the work is of beams.
    pub list: vk::Pipeline,
    /// The pipelines of tiles whose patches are listed.
    pub listed: [vk::Pipeline; LIST_LENGTHS.len()],
    /// What the pipeline was compiled for.
    pub key: Option<(Variant, Kind)>,
    pub tables_offset: u32,
    /// Likewise of the patches that lists are made from, and the vector with which they begin.
    pub patches_offset: u32,
    pub patches: u32,
    /// Vectors with which frusta, tables begin.
    pub frusta: u32,
    pub tables: u32,
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

    /// Adds an object; it is drawn from the next prepared frame on, after those that were there
    /// before.
    ///
    /// # Errors
    /// [`Stage::Scene`] for values out of range, with the key; [`Stage::Draw`] for more than 2^32
    /// instances.
    pub fn add(&mut self, object: Object) -> Result<ObjectId> {
        object.check()?;
        let instances = self.allocate_instances(object.placements().len())?;
        let free = self.entries.iter().position(Option::is_none);
        let number = free.unwrap_or(self.entries.len());
        if free.is_none() {
            self.entries.push(None);
            self.generations.push(0);
        }
        self.entries[number] = Some(Entry {
            object,
            wanted: None,
            grown: None,
            prepared: None,
            draw: Draw::default(),
            instances,
            stale: 0,
        });
        let number = u32::try_from(number).unwrap_or(u32::MAX);
        self.order.push(number);
        self.changed.push(number);
        self.reordered();
        Ok(ObjectId {
            number,
            generation: self.generations[number as usize],
        })
    }

    /// Takes an object away. What frames in flight read of it is kept until they are done.
    ///
    /// # Errors
    /// [`Stage::Usage`] for an object that is not there.
    pub fn remove(&mut self, id: ObjectId) -> Result<()> {
        self.entry(id)?;
        let number = id.number as usize;
        self.generations[number] += 1;
        if let Some(entry) = self.entries[number].take() {
            self.instances.free_range(entry.instances.clone());
            self.retire(entry.prepared);
        }
        for list in [&mut self.order, &mut self.changed, &mut self.unplanned] {
            list.retain(|&n| n != id.number);
        }
        for slot in &mut self.frames {
            slot.stale.retain(|&n| n != id.number);
        }
        self.reordered();
        Ok(())
    }

    /// Gives an object other values, all of them. What is equal costs nothing.
    ///
    /// # Errors
    /// [`Stage::Scene`] for values out of range, with the key; [`Stage::Usage`] for an object that
    /// is not there.
    pub fn set(&mut self, id: ObjectId, object: Object) -> Result<()> {
        object.check()?;
        if self.entry(id)?.latest().same_look(&object) {
            if self.entry(id)?.latest().instances != object.instances {
                self.set_instances(id, object.instances)?;
            }
            return self.set_placement(id, object.placement);
        }
        let count = object.placements().len();
        if self.entry(id)?.placements_len() != count {
            self.resize_instances(id, count)?;
        }
        self.entry(id)?.wanted = Some(object);
        self.changed.push(id.number);
        Ok(())
    }

    /// Moves the surface of an object.
    ///
    /// # Errors
    /// As [`Renderer::set`].
    pub fn set_offset(&mut self, id: ObjectId, offset: Offset) -> Result<()> {
        offset.check()?;
        let entry = self.entry(id)?;
        if entry.latest().offset == offset {
            return Ok(());
        }
        let (wanted, object) = (&mut entry.wanted, &entry.object);
        wanted.get_or_insert_with(|| object.clone()).offset = offset;
        self.changed.push(id.number);
        Ok(())
    }

    /// Moves an object that is one copy.
    ///
    /// # Errors
    /// As [`Renderer::set`].
    pub fn set_placement(&mut self, id: ObjectId, placement: Placement) -> Result<()> {
        placement.check()?;
        let entry = self.entry(id)?;
        if entry.latest().placement == placement {
            return Ok(());
        }
        entry.object.placement = placement;
        if let Some(wanted) = &mut entry.wanted {
            wanted.placement = placement;
        }
        if let Some(grown) = &mut entry.grown {
            grown.object.placement = grown.growth.placement(&placement);
        }
        self.unplanned.push(id.number);
        Ok(())
    }

    /// Gives an object other copies; none: one, at its placement.
    ///
    /// # Errors
    /// As [`Renderer::set`].
    pub fn set_instances(&mut self, id: ObjectId, instances: Vec<Placement>) -> Result<()> {
        for placement in &instances {
            placement.check()?;
        }
        let count = instances.len().max(1);
        if self.entry(id)?.placements_len() != count {
            self.resize_instances(id, count)?;
        }
        let entry = self.entry(id)?;
        if let Some(wanted) = &mut entry.wanted {
            wanted.instances.clone_from(&instances);
        }
        if let Some(grown) = &mut entry.grown {
            let all = instances.iter().map(|p| grown.growth.placement(p));
            grown.object.instances = all.collect();
        }
        entry.object.instances = instances;
        self.unplanned.push(id.number);
        Ok(())
    }

    /// Sets lights and shadows for all objects.
    ///
    /// # Errors
    /// [`Stage::Scene`] for values out of range, with the key.
    pub fn set_lighting(&mut self, lighting: &Lighting) -> Result<()> {
        lighting.check()?;
        super::block::check_lights(lighting)?;
        let codes = |l: &Lighting| (l.lights.len(), l.shadow);
        if codes(lighting) != codes(&self.lighting) {
            self.changed.extend(&self.order);
        }
        self.lighting = lighting.clone();
        Ok(())
    }

    /// The objects, in the order in which they were added.
    pub fn ids(&self) -> impl Iterator<Item = ObjectId> + '_ {
        self.order.iter().map(|&number| ObjectId {
            number,
            generation: self.generations[number as usize],
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

    fn entry(&mut self, id: ObjectId) -> Result<&mut Entry> {
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

    /// What depends on the order: depths that compute compares, shadows' lists.
    fn reordered(&mut self) {
        self.version += 1;
        if matches!(self.output, Output::Compute(_)) {
            self.unplanned.extend(&self.order);
        }
    }

    fn allocate_instances(&mut self, count: usize) -> Result<Range<u32>> {
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

    fn resize_instances(&mut self, id: ObjectId, count: usize) -> Result<()> {
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

impl Entry {
    /// The values that were set last.
    pub fn latest(&self) -> &Object {
        self.wanted.as_ref().unwrap_or(&self.object)
    }

    /// The values that were prepared last, in a box that cuts nothing.
    pub fn drawn(&self) -> &Object {
        self.grown.as_ref().map_or(&self.object, |g| &g.object)
    }

    fn placements_len(&self) -> usize {
        self.latest().placements().len()
    }
}
