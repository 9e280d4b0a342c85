//! Objects on a device, ready to be recorded into any command buffer.
//!
//! `objects.rs` changes objects and lights, `prepare.rs` prepares the plan of a view for a slot by the
//! data of `blocks.rs`, `record.rs` records it. `prewarm.rs` compiles pipelines before they are needed, and `costs.rs`
//! says what objects take.

mod blocks;
pub(super) mod costs;
mod objects;
mod output_check;
pub(super) mod prepare;
pub(super) mod prewarm;
mod record;
pub(super) mod slot;
pub(super) mod statistics;

use crate::error::{Error, ErrorKind, Result};
use crate::gpu::content::Content;
use crate::gpu::content::snapshot::distinct;
use crate::gpu::device::Shared;
use crate::gpu::open::Device;
use crate::gpu::resources::geometry::Geometry;
use crate::gpu::vk::output::{ComputeTarget, HostShading, Output};
use crate::gpu::vk::pipelines::Owner;
use crate::plan::{DrawPath, OpenPixels};
use crate::scene::Lighting;
use crate::settings::SearchSettings;
use ash::vk;
use slot::FrameSlot;
use std::collections::HashMap;
use std::sync::Arc;

/// Objects on a device, drawn into whatever the host draws into.
///
/// [`Renderer::prepare`] prepares a frame of one view in a **slot** and returns a token, by which
/// the frame is recorded. A slot holds all that its frame reads. Any number of slots may be
/// prepared before any is recorded; values set in between take effect in the next frame. A host
/// with two frames in flight and three views needs six slots.
///
/// ```text
/// renderer.set_placement(pawn, there)?;                   // any number of changes
/// let frame = renderer.prepare(cmd, slot, &view)?;        // outside of a render pass
/// begin_rendering(cmd); renderer.record(cmd, &frame)?; .. // inside
/// ```
///
/// Neither call submits or waits, or compiles a pipeline once [`Renderer::prewarm`] was compiled. Memory is allocated
/// while buffers still grow. A renderer must live until the frames that it recorded are done.
pub struct Renderer {
    pub(super) content: Content,
    pub(super) slots: Vec<FrameSlot>,
    /// The owner of its pipelines, with the host's shading. It is dropped before the device.
    pub(super) owner: Arc<Owner>,
    /// True if `prepare` compiles nothing.
    pub(super) hides: bool,
    pub(super) device: Arc<Shared>,
}

const MOST_SLOTS: usize = 64;

impl Renderer {
    /// Makes a renderer without objects, for one output, with this many slots (1 to 64): frames in
    /// flight times views.
    ///
    /// # Errors
    /// [`ErrorKind::Usage`] for another number of slots, and for attachments that do not fit the
    /// planes; [`ErrorKind::Unsupported`] for formats and samples that the device does not draw
    /// into, and for all planes in a pass without `fragmentStoresAndAtomics`; errors of Vulkan
    /// calls.
    pub fn new(
        device: &Device,
        output: Output,
        settings: &SearchSettings,
        slots: usize,
    ) -> Result<Self> {
        Self::make(device, output, settings, slots, None)
    }

    /// Same as [`Renderer::new`], with a function of the host that shades in place of the library's.
    /// The function takes no lights of [`Renderer::set_lighting`].
    ///
    /// # Errors
    /// The errors of [`Renderer::new`]. [`ErrorKind::Usage`] for a shading of the other stage, for an
    /// output without colour, for a search other than `exact`, `quadric` and `live`, for a function
    /// that reads another set than 3, and for one that reads set 3 if the layout is null.
    /// [`ErrorKind::Unsupported`] for a function whose textures, with the library's 4, are more than
    /// a stage of the device has.
    ///
    /// # Safety
    /// The call makes a pipeline layout with the host's set, and pipelines are made with it.
    ///
    /// The caller must ensure that
    /// * the shading was compiled by this library, or its bytes were written by it;
    /// * the layout is of this device, has every binding that the function reads, and lives as long
    ///   as the renderer and its [`Prewarm`](crate::gpu::Prewarm)s;
    /// * the layout's descriptors, with the library's, are within the limits of the device;
    /// * the function ends and reads only what the bound set has;
    /// * a set of the layout is bound at number 3, with [`Renderer::pipeline_layout`], whenever
    ///   [`Renderer::record`], [`Renderer::record_compute`] or [`Renderer::record_prewarm`] is called.
    ///   These calls leave it bound.
    pub unsafe fn with_shading(
        device: &Device,
        output: Output,
        settings: &SearchSettings,
        slots: usize,
        shading: &HostShading,
    ) -> Result<Self> {
        shading.check(&output, settings, device.shared.limits())?;
        Self::make(device, output, settings, slots, Some(shading))
    }

    fn make(
        device: &Device,
        output: Output,
        settings: &SearchSettings,
        slots: usize,
        shading: Option<&HostShading>,
    ) -> Result<Self> {
        if !(1..=MOST_SLOTS).contains(&slots) {
            let message = format!("{slots} slots for frames in flight; give 1 to {MOST_SLOTS}");
            return Err(Error::new(ErrorKind::Usage, message));
        }
        output.check(&device.shared, settings)?;
        settings.check()?;
        let geometry = Geometry::of(&device.shared, &device.geometry)?;
        let device = device.shared.clone();
        let owner = Arc::new(device.pipelines.owner(&output, shading)?);
        let content = Content::new(&device, geometry, output, settings, shading.is_some())?;
        Ok(Self {
            slots: (0..slots)
                .map(|_| FrameSlot::new(&device))
                .collect::<Result<_>>()?,
            hides: false,
            owner,
            content,
            device,
        })
    }

    /// The number of objects.
    #[must_use]
    pub fn object_count(&self) -> usize {
        self.content.objects.len()
    }

    /// Notes on each thing that was done in another way than the settings say, and why; each once.
    #[must_use]
    pub fn notes(&self) -> &[String] {
        &self.content.notes
    }

    /// The lights that were set last.
    #[must_use]
    pub fn lighting(&self) -> &Lighting {
        &self.content.lighting
    }

    /// The draw path of each object in the last planned frame, in order.
    #[must_use]
    pub fn draw_paths(&self) -> Vec<DrawPath> {
        let Some(plan) = &self.content.plan else {
            return Vec::new();
        };
        let drawn = plan.objects.iter().map(|planned| planned.object.number);
        let paths: HashMap<u32, DrawPath> = drawn.zip(plan.frame.paths.iter().copied()).collect();
        let path = |(number, _)| paths.get(&number).copied().unwrap_or(DrawPath::Nothing);
        self.content.objects.ordered().map(path).collect()
    }

    /// The number of surfaces that were made: one for each profile under each offset that no object
    /// had in the previous frame. A moving camera makes surfaces of levels that it needs for the
    /// first time; with [`Tolerance::EXACT`](crate::settings::Tolerance::EXACT) it makes none.
    /// Searches on the map never make any. A contour that does not close counts as a surface.
    #[must_use]
    pub fn rebuild_count(&self) -> u64 {
        self.content.rebuilds
    }

    /// Bytes of maps on the device: first shape maps with tables of lengths, then colour and
    /// displacement maps.
    #[must_use]
    pub fn map_bytes(&self) -> [u64; 2] {
        let mut images = Vec::new();
        for object in &self.content.snapshot.objects {
            let derived = &object.derived;
            images.extend(derived.map.as_ref().map(|map| map.texture.clone()));
            images.extend(derived.arc.as_ref().map(|arc| arc.texture.clone()));
        }
        let shapes = distinct(&mut images).iter().map(|image| image.bytes());
        [shapes.sum(), self.content.textures.bytes()]
    }

    /// With `true`, [`Renderer::prepare`] compiles no pipeline. Whatever needs one that is not
    /// compiled stays hidden until [`Prewarm::compile`](crate::gpu::Prewarm::compile) has made it
    /// on another thread; [`FrameStatistics::hidden`](crate::gpu::FrameStatistics::hidden) counts
    /// what is left out. An object that several pipelines draw may show in part. Content that is
    /// added later may need pipelines that an earlier `Prewarm` does not have: call
    /// [`Renderer::prewarm`] again. A hidden solid still hides copies behind it and still casts
    /// shadows. Default: false.
    pub fn hide_until_compiled(&mut self, hides: bool) {
        self.hides = hides;
    }

    /// The layout of all pipelines of the renderer, with which a host binds its set 3. It lives as long
    /// as the renderer.
    ///
    /// # Errors
    /// None in this version.
    pub fn pipeline_layout(&self) -> Result<vk::PipelineLayout> {
        let shared = self.device.pipelines.layout;
        Ok(self.owner.shading.as_ref().map_or(shared, |own| own.layout))
    }

    /// Chooses the pixels that the compute stage draws in the next prepared frames; all if `None`.
    /// Tiles without them are left out, and in others some pixels may still be drawn. For rays where
    /// a picture needs more of them.
    pub fn set_open_pixels(&mut self, open: Option<OpenPixels>) {
        self.content.open = open.map(Arc::new);
    }

    /// Sets the memory that compute writes to, from the next prepared frame on.
    ///
    /// # Errors
    /// [`ErrorKind::Usage`] for null handles, for another number of images than [`ComputeTarget`]
    /// says, and for an output without a target.
    ///
    /// # Safety
    /// The call keeps the handles; [`Renderer::prepare`] binds them.
    ///
    /// The caller must ensure that
    /// * the handles are of this device, as [`ComputeTarget`] describes them, and as wide and high as
    ///   every view's viewport, rounded down to whole pixels;
    /// * they live until another target is set and the frames that were recorded before are done.
    pub unsafe fn set_compute_target(&mut self, target: ComputeTarget) -> Result<()> {
        self.content.output.check_target(Some(&target))?;
        self.content.target = Some(target);
        self.slots.iter_mut().for_each(|slot| slot.named = None);
        Ok(())
    }
}
