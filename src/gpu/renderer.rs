//! A scene on a device: baked, uploaded, compiled; then drawn as often as wanted.

use super::buffers::Buffers;
use super::clock::Clock;
use super::commands::Commands;
use super::contours::Contours;
use super::cuts::Cuts;
use super::descriptors::Descriptors;
use super::device::{Device, Shared};
use super::meshes::Meshes;
use super::pipelines::Pipelines;
use super::target::Target;
use super::textures::Textures;
use super::work::{Batch, MOST_BEAMED, Way, Work};
use crate::error::{Error, Result, Stage};
use crate::frame::Frame;
use crate::scene::Scene;
use crate::settings::Settings;
use ash::vk;
use std::sync::Arc;
use std::time::Instant;

/// What one frame cost.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Times {
    /// Milliseconds between GPU timestamps around the work; `None` where the device has none.
    pub gpu_ms: Option<f64>,
    /// Milliseconds from submission to completion by the wall clock.
    pub frame_ms: f64,
}

/// A scene ready to be drawn on a device.
///
/// [`Renderer::update`] is in `update.rs`, what is recorded of it in `record.rs`.
pub struct Renderer {
    // Vulkan objects in order of destruction; `device` last.
    pub(super) pipelines: Pipelines,
    pub(super) target: Target,
    pub(super) descriptors: Descriptors,
    pub(super) batches: Vec<Batch>,
    pub(super) textures: Textures,
    /// What the searches' tables, or meshes, are built from; empty for other searches.
    pub(super) contours: Contours,
    /// The tables of the last frame.
    pub(super) cuts: Cuts,
    /// None where there is a search.
    pub(super) meshes: Option<Meshes>,
    pub(super) notes: Vec<String>,
    pub(super) buffers: Buffers,
    pub(super) commands: Commands,
    pub(super) clock: Clock,
    pub(super) settings: Settings,
    pub(super) background: [f32; 4],
    /// From the first thing that an update changes to the last: what one that failed in between has left must not be drawn.
    pub(super) stale: bool,
    pub(super) device: Arc<Shared>,
}

impl Renderer {
    /// Bakes and uploads the scene's maps, compiles its pipelines, and makes a target of the settings' size.
    ///
    /// # Errors
    /// Of baking ([`Stage::Map`]), of the scene's values ([`Stage::Scene`]), of Vulkan ([`Stage::Draw`]).
    pub fn new(device: &Device, scene: &Scene, settings: &Settings) -> Result<Self> {
        let device = device.shared.clone();
        let meshes = Meshes::new(&device, scene, settings)?;
        let commands = Commands::new(&device)?;
        let size = (settings.width, settings.height);
        let pipelines = Pipelines::new(&device, settings.planes)?;
        let target = Target::new(&device, &pipelines, settings.stage, settings.planes, size)?;

        let textures = Textures::new(&device, &commands, scene, settings)?;
        let mut batches = Vec::new();
        let mut instances = 0u32;
        let mut blocks = scene.objects.len();
        for object in &scene.objects {
            let copies = object.placements().len();
            blocks += if copies <= MOST_BEAMED { copies } else { 0 };
            let end = u32::try_from(object.placements().len())
                .ok()
                .and_then(|n| instances.checked_add(n))
                .ok_or_else(|| Error::new(Stage::Draw, "more than 2^32 instances"))?;
            batches.push(Batch {
                pipeline: vk::Pipeline::null(),
                textures: vk::DescriptorSet::null(),
                block_offset: 0,
                tables_offset: 0,
                instances: instances..end,
                work: Work::Nothing,
            });
            instances = end;
        }
        let contours = Contours::of(scene, settings)?;
        let mut renderer = Self {
            buffers: Buffers::new(&device, blocks, instances)?,
            descriptors: Descriptors::new(&device, &pipelines, batches.len())?,
            pipelines,
            target,
            batches,
            textures,
            contours,
            cuts: Cuts::default(),
            meshes,
            notes: Vec::new(),
            clock: Clock::new(&device)?,
            commands,
            settings: *settings,
            background: scene.background,
            stale: true,
            device,
        };
        renderer.update(scene)?;
        Ok(renderer)
    }

    /// Draws one frame and waits for it.
    ///
    /// # Errors
    /// Of Vulkan ([`Stage::Draw`]); [`Stage::Draw`], too, after an update that has failed half way.
    pub fn draw(&mut self) -> Result<Times> {
        self.check_whole()?;
        // Buffers may have been replaced, and what was uploaded or read back has recorded something else.
        self.commands.record(|cmd| self.record(cmd))?;
        let start = Instant::now();
        self.commands.submit_and_wait()?;
        let frame_ms = start.elapsed().as_secs_f64() * 1e3;
        Ok(Times {
            gpu_ms: self.clock.milliseconds()?,
            frame_ms,
        })
    }

    /// Bytes that the scene's maps take on the device: shape maps (or meshes), and colour and displacement maps.
    #[must_use]
    pub fn map_bytes(&self) -> [u64; 2] {
        let [shapes, surfaces] = self.textures.bytes();
        let meshes = self.meshes.as_ref().map_or(0, Meshes::bytes);
        [shapes + meshes, surfaces]
    }

    /// What was done in another way than asked for, and why; each thing once.
    #[must_use]
    pub fn notes(&self) -> &[String] {
        &self.notes
    }

    /// How each object is drawn since the last update that succeeded, in order.
    #[must_use]
    pub fn ways(&self) -> Vec<Way> {
        self.batches.iter().map(|b| Way::from(&b.work)).collect()
    }

    /// How many contours were cut (or tessellated) since the renderer was made: one for each profile under each offset that was not there in
    /// the update before. A camera that moves cuts none. Searches on the map never do.
    #[must_use]
    pub fn cuts(&self) -> u64 {
        self.cuts.done() + self.meshes.as_ref().map_or(0, Meshes::cuts)
    }

    fn check_whole(&self) -> Result<()> {
        if self.stale {
            return Err(Error::new(
                Stage::Draw,
                "the last update failed half way; update again with what can be drawn, or make a new renderer",
            ));
        }
        Ok(())
    }

    /// Reads the last drawn frame back.
    ///
    /// # Errors
    /// As [`Renderer::draw`].
    pub fn read(&self) -> Result<Frame> {
        self.check_whole()?;
        let planes = self.target.read(&self.commands)?;
        super::read_back::frame(&self.settings, self.background, &planes)
    }
}
