//! Frames without a host: a target, commands, and reading back. The first user of [`Renderer`].

mod bands;
mod commands;
mod draw;
mod read_back;
mod target;

pub use draw::{Guest, Times};

use crate::antialias::Solids;
use crate::error::{Error, ErrorKind, Result};
use crate::frame::Frame;
use crate::gpu::content::objects::ObjectId;
use crate::gpu::device::Shared;
use crate::gpu::offscreen::bands::Bands;
use crate::gpu::offscreen::commands::Clock;
use crate::gpu::offscreen::commands::Commands;
use crate::gpu::offscreen::target::Target;
use crate::gpu::open::Device;
use crate::gpu::renderer::Renderer;
use crate::gpu::renderer::costs::ObjectCost;
use crate::gpu::vk::output::{Output, PassFormats, PassKind};
use crate::plan::{DrawPath, View};
use crate::scene::{CameraFrame, Object, Scene};
use crate::settings::{DrawStage, Planes, SearchSettings, Settings};
use ash::vk;
use std::sync::Arc;

/// A scene on a device, and the picture that it is drawn into.
pub struct Offscreen {
    // Vulkan objects in order of destruction; `device` last.
    renderer: Renderer,
    target: Target,
    commands: Commands,
    clock: Clock,
    ids: Vec<ObjectId>,
    view: View,
    background: [f32; 4],
    settings: Settings,
    /// True if a guest draws the scene's objects.
    guests_only: bool,
    /// The solids and the camera that smooth silhouettes; `None` without antialiasing.
    solids: Option<(Solids, CameraFrame)>,
    /// True between the first and the last change of an update. The remains of an update that
    /// failed in between must not be drawn.
    stale: bool,
    bands: Bands,
    /// Copies of all objects of the last update.
    copies: usize,
    /// The pass of a frame's first rows, and the one of the rows after them; null in compute.
    passes: [vk::RenderPass; 2],
    device: Arc<Shared>,
}

/// How a scene is drawn off screen, beside the settings.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct OffscreenOptions {
    /// True if a guest draws the scene's objects, now and after every update. Camera, background,
    /// lights and the range of depths are the scene's. Default: false.
    pub guests_only: bool,
    /// Samples of a pixel in the fragment stage, 1, 2, 4 or 8; a frame holds their means. Default:
    /// 1. Each sample has a ray, which needs `sampleRateShading`.
    pub samples: u32,
    /// Most milliseconds of a submission, because systems reset a device whose submission takes
    /// seconds (2 s on Windows). A frame that takes longer is drawn in several bands of rows, by the
    /// times of the rows before and of the frame before. Bands have the bits of a whole frame, in
    /// compute but for roundings. The limit is an aim: the first frame after other
    /// objects, copies or lights begins with 2^20 rays, whatever they take. Default: none, which is
    /// 500 on GPUs and no limit on CPUs.
    pub submission_ms: Option<f64>,
}

impl Default for OffscreenOptions {
    fn default() -> Self {
        Self {
            guests_only: false,
            samples: 1,
            submission_ms: None,
        }
    }
}

impl Offscreen {
    /// Bakes and uploads the scene's maps, and makes a target of the settings' size. The first
    /// frame compiles the pipelines.
    ///
    /// # Errors
    /// Errors of baking and of the scene's values ([`ErrorKind::Content`]); [`ErrorKind::TooLarge`]
    /// for more pixels than the device takes; errors of Vulkan calls.
    pub fn new(device: &Device, scene: &Scene, settings: &Settings) -> Result<Self> {
        Self::with(device, scene, settings, OffscreenOptions::default())
    }

    /// Same as [`Offscreen::new`], with options.
    ///
    /// # Errors
    /// Same as [`Offscreen::new`]; [`ErrorKind::Usage`] for several samples in compute.
    pub fn with(
        device: &Device,
        scene: &Scene,
        settings: &Settings,
        options: OffscreenOptions,
    ) -> Result<Self> {
        let OffscreenOptions {
            guests_only,
            samples,
            submission_ms,
        } = options;
        // Several samples smooth silhouettes by themselves.
        let settings = &Settings {
            antialias: settings.antialias && samples == 1,
            ..*settings
        };
        if samples != 1 && settings.stage == DrawStage::Compute {
            let message = "compute draws one sample a pixel; give the stage fragment";
            return Err(Error::new(ErrorKind::Usage, message).at_key("samples"));
        }
        if !matches!(settings.planes, Planes::Color | Planes::All) {
            let message = "depths and lists are drawn in a host's pass; give color or all";
            return Err(Error::new(ErrorKind::Usage, message));
        }
        let size = (settings.width, settings.height);
        let view = View::of_scene(scene, size)?;
        // All planes include distances.
        let keeps_depths = settings.antialias && settings.planes == Planes::Color;
        let shared = device.shared.clone();
        let commands = Commands::new(&shared)?;
        let pass = |resumes| match settings.stage {
            DrawStage::Compute => Ok(vk::RenderPass::null()),
            _ => (shared.pipelines).own_pass(settings.planes, keeps_depths, samples, resumes),
        };
        let passes = [pass(false)?, pass(true)?];
        let target = Target::new(
            &shared,
            passes[0],
            settings.stage,
            settings.planes,
            keeps_depths,
            samples,
            size,
        )?;
        let output = match settings.stage {
            DrawStage::Compute => Output::Compute(settings.planes),
            _ => Output::Pass(PassFormats {
                samples,
                sample_rays: samples > 1,
                ..PassFormats::new(
                    PassKind::RenderPass {
                        pass: passes[0],
                        subpass: 0,
                    },
                    settings.planes,
                )
            }),
        };
        let mut renderer = Renderer::new(device, output, &SearchSettings::from(settings), 1)?;
        if let Some(target) = target.for_shaders() {
            // SAFETY: the target belongs to this device and has the size of all views; it is
            // dropped after the renderer.
            unsafe { renderer.set_compute_target(target) }?;
        }
        let mut offscreen = Self {
            renderer,
            target,
            commands,
            clock: Clock::new(&shared)?,
            ids: Vec::new(),
            view,
            background: scene.background,
            settings: *settings,
            guests_only,
            solids: None,
            stale: true,
            bands: Bands::new(submission_ms, shared.chosen.report.kind == "cpu", samples),
            copies: 0,
            passes,
            device: shared,
        };
        offscreen.update(scene)?;
        Ok(offscreen)
    }

    /// Applies a scene: camera, lights, and objects, of which there may be more or fewer. The cost
    /// follows the differences from the previous scene.
    ///
    /// # Errors
    /// [`ErrorKind::Content`] for the scene's values, profiles and maps; the previous scene can
    /// still be drawn. Errors of Vulkan calls; nothing is drawn then before an update succeeds.
    pub fn update(&mut self, scene: &Scene) -> Result<()> {
        scene.check()?;
        let view = View::of_scene(scene, (self.settings.width, self.settings.height))?;
        self.apply(scene, &view)?;
        self.view = view;
        self.background = scene.background;
        self.stale = true;
        if self.settings.antialias {
            let (width, height) = (self.settings.width, self.settings.height);
            let camera = CameraFrame::new(&scene.camera, width, height)?;
            let mut solids = self.solids.take().map_or_else(Solids::default, |s| s.0);
            solids.update(scene);
            self.solids = Some((solids, camera));
        }
        self.stale = false;
        Ok(())
    }

    /// Applies a whole scene or nothing: a failure undoes all changes.
    fn apply(&mut self, scene: &Scene, view: &View) -> Result<()> {
        let lighting = scene.lighting();
        let before = self.renderer.lighting().clone();
        let count = scene.objects.iter().map(|o| o.instances.len().max(1)).sum();
        if lighting != before || count != std::mem::replace(&mut self.copies, count) {
            self.bands.forget();
        }
        let objects: &[Object] = if self.guests_only {
            &[]
        } else {
            &scene.objects
        };
        let (kept, there) = (objects.len().min(self.ids.len()), self.ids.len());
        let mut removed = Vec::new();
        for id in self.ids.split_off(kept) {
            removed.push(self.renderer.object(id)?.clone());
            self.renderer.remove(id)?;
        }
        let mut change = || {
            self.renderer.set_lighting(&lighting)?;
            for (&id, object) in self.ids.iter().zip(objects) {
                // Copies are many, and seldom move.
                if !self.renderer.object(id)?.equals(object) {
                    self.renderer.set(id, object.clone())?;
                }
            }
            for object in &objects[kept..] {
                self.ids.push(self.renderer.add(object.clone())?);
            }
            self.renderer.plan(view)
        };
        let result = change();
        if result.is_err() {
            for id in self.ids.split_off(kept) {
                self.renderer.remove(id)?;
            }
            for object in removed {
                self.ids.push(self.renderer.add(object)?);
            }
            self.renderer.set_lighting(&before)?;
            // A first scene has no earlier state to restore.
            if there > 0 {
                self.renderer.plan(view)?;
            }
        }
        result
    }

    /// The pass for a guest's pipelines; null in compute. The pass lives as long as the device.
    #[must_use]
    pub fn render_pass(&self) -> vk::RenderPass {
        self.passes[0]
    }

    /// The view of the last scene.
    #[must_use]
    pub fn view(&self) -> &View {
        &self.view
    }

    /// The frame that was drawn last.
    ///
    /// # Errors
    /// Errors of Vulkan calls; [`ErrorKind::Usage`] after an update that failed half way.
    pub fn read(&mut self) -> Result<Frame> {
        self.check_whole()?;
        let planes = self.target.read(&self.commands)?;
        let (settings, background) = (&self.settings, self.background);
        match &self.solids {
            Some(by) => read_back::smoothed(settings, background, &planes, by, &self.view),
            None => read_back::frame(settings, background, &planes),
        }
    }

    /// The colours of the frame that was drawn last, sRGB with alpha in 8 bits each, row 0 on top,
    /// without smoothed silhouettes: for a window, which has no time to make a [`Frame`].
    ///
    /// # Errors
    /// Errors of Vulkan calls; [`ErrorKind::Usage`] after an update that failed half way, and for
    /// other planes than [`Planes::Color`].
    pub fn rgba(&mut self) -> Result<Vec<[u8; 4]>> {
        self.check_whole()?;
        if self.settings.planes != Planes::Color {
            let message = "pictures are of colours alone; read a frame of all planes";
            return Err(Error::new(ErrorKind::Usage, message));
        }
        let planes = self.target.read(&self.commands)?;
        let colors = planes.first().copied().unwrap_or_default();
        Ok(colors.as_chunks().0.to_vec())
    }

    /// Same as [`Renderer::map_bytes`].
    #[must_use]
    pub fn map_bytes(&self) -> [u64; 2] {
        self.renderer.map_bytes()
    }

    /// Same as [`Renderer::notes`].
    #[must_use]
    pub fn notes(&self) -> &[String] {
        self.renderer.notes()
    }

    /// Same as [`Renderer::draw_paths`], since the last update that succeeded.
    #[must_use]
    pub fn draw_paths(&self) -> Vec<DrawPath> {
        self.renderer.draw_paths()
    }

    /// Same as [`Renderer::object_costs`], since the last update that succeeded.
    #[must_use]
    pub fn object_costs(&self) -> Vec<ObjectCost> {
        self.renderer.object_costs()
    }

    /// Same as [`Renderer::copy_levels`], since the last update that succeeded.
    #[must_use]
    pub fn copy_levels(&self) -> Vec<Vec<u8>> {
        self.renderer.copy_levels()
    }

    /// Same as [`Renderer::device_bytes`]; the target is not counted.
    #[must_use]
    pub fn device_bytes(&self) -> u64 {
        self.renderer.device_bytes()
    }

    /// Same as [`Renderer::rebuild_count`].
    #[must_use]
    pub fn rebuild_count(&self) -> u64 {
        self.renderer.rebuild_count()
    }

    fn check_whole(&self) -> Result<()> {
        if self.stale {
            return Err(Error::new(
                ErrorKind::Usage,
                "the last update failed half way; update again with what can be drawn, or make a new one",
            ));
        }
        Ok(())
    }
}
