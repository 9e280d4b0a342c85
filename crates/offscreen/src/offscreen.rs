//! A scene on a device and the picture that it is drawn into.

use crate::antialias::Solids;
use crate::bands::Bands;
use crate::commands::Commands;
use crate::read_back;
use crate::target::{DEPTH, Target, color_formats};
use ash::vk;
use revmap::error::{Error, ErrorKind, Result};
use revmap::frame::{Frame, pixel_count};
use revmap::gpu::{Device, ObjectId, OpenPixels, Output, PassFormats, PassKind, Renderer, View};
use revmap::host_memory;
use revmap::scene::{CameraFrame, Object, Scene};
use revmap::settings::{DrawStage, Planes, SearchSettings, Settings};

/// A scene on a device, and the picture that it is drawn into.
pub struct Offscreen {
    // The renderer is destroyed first, as it draws into the target.
    pub(crate) renderer: Renderer,
    pub(crate) target: Target,
    pub(crate) commands: Commands,
    pub(crate) bands: Bands,
    /// The scene of the last update that succeeded, its view and the identities of its objects.
    pub(crate) scene: Scene,
    pub(crate) view: View,
    ids: Vec<ObjectId>,
    pub(crate) settings: Settings,
    /// True if times leave out the compilation of pipelines.
    pub(crate) warm: bool,
    /// True if a guest draws the scene's objects.
    guests_only: bool,
    /// The solids whose silhouettes were smoothed last.
    solids: Solids,
    /// True if the renderer has all of `scene`. The remains of an update that failed half way must not
    /// be drawn.
    whole: bool,
    pub(crate) device: Device,
}

impl Drop for Offscreen {
    fn drop(&mut self) {
        // A wait that failed has left a submission. Without memory for this one, nothing remains but to
        // go on; a lost device has ended it.
        let _ = self.commands.wait();
    }
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
    /// for more pixels than the device or a frame takes; errors of Vulkan calls.
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
        // A frame holds so many; the device may draw more.
        pixel_count(settings.width, settings.height).map_err(|e| e.at_key("size"))?;
        let planes = settings.planes;
        // Several samples smooth silhouettes by themselves.
        let settings = Settings {
            antialias: settings.antialias && samples == 1,
            ..*settings
        };
        if samples != 1 && settings.stage == DrawStage::Compute {
            let message = "compute draws one sample a pixel; give the stage fragment";
            return Err(Error::new(ErrorKind::Usage, message).at_key("samples"));
        }
        if !matches!(planes, Planes::Color | Planes::All) {
            let message = "depths and lists are drawn in a host's pass; give color or all";
            return Err(Error::new(ErrorKind::Usage, message));
        }
        let view = View::of_scene(scene, (settings.width, settings.height))?;
        let commands = Commands::new(device)?;
        let target = Target::new(device, &settings, samples)?;
        let begun = PassKind::SingleSubpass {
            color: color_formats(planes),
            depth: DEPTH,
        };
        let output = match settings.stage {
            DrawStage::Compute => Output::Compute(planes),
            DrawStage::Fragment => Output::Pass(PassFormats {
                samples,
                sample_rays: samples > 1,
                ..PassFormats::new(begun, planes)
            }),
        };
        let mut renderer = Renderer::new(device, output, &SearchSettings::from(&settings), 1)?;
        if let Some(target) = target.for_shaders() {
            // SAFETY: the target belongs to this device and has the size of all views; it is
            // dropped after the renderer.
            unsafe { renderer.set_compute_target(target) }?;
        }
        let is_cpu = device.report().kind == "cpu";
        let mut offscreen = Self {
            renderer,
            target,
            commands,
            bands: Bands::new(submission_ms, is_cpu, samples),
            scene: Scene::new(scene.camera),
            view,
            ids: Vec::new(),
            settings,
            warm: false,
            guests_only,
            solids: Solids::default(),
            whole: false,
            device: device.clone(),
        };
        offscreen.update(scene)?;
        Ok(offscreen)
    }

    /// Applies a scene: camera, lights, and objects, of which there may be more or fewer. The cost
    /// follows the differences from the previous scene.
    ///
    /// # Errors
    /// [`ErrorKind::Content`] for the scene's values, profiles and maps; the previous scene can
    /// still be drawn. Errors of Vulkan calls; nothing is drawn then before an update succeeds, if
    /// the previous scene cannot be restored.
    pub fn update(&mut self, scene: &Scene) -> Result<()> {
        scene.check()?;
        let copies = |scene: &Scene| -> usize {
            (scene.objects.iter().map(|object| object.placements().len())).sum()
        };
        let lit_alike = scene.lighting() == self.scene.lighting();
        if !lit_alike || copies(scene) != copies(&self.scene) {
            self.bands.forget();
        }
        let applied = self.apply(scene);
        self.whole = applied.is_ok() || self.apply(&self.scene.clone()).is_ok();
        applied
    }

    /// Makes the renderer's content that of a scene.
    fn apply(&mut self, scene: &Scene) -> Result<()> {
        let view = View::of_scene(scene, (self.settings.width, self.settings.height))?;
        let objects: &[Object] = match self.guests_only {
            true => &[],
            false => &scene.objects,
        };
        let kept = objects.len().min(self.ids.len());
        for id in self.ids.split_off(kept) {
            self.renderer.remove(id)?;
        }
        self.renderer.set_lighting(&scene.lighting())?;
        for (&id, object) in self.ids.iter().zip(objects) {
            if self.renderer.object(id)? != object {
                self.renderer.set(id, object.clone())?;
            }
        }
        for object in &objects[kept..] {
            self.ids.push(self.renderer.add(object.clone())?);
        }
        self.renderer.plan(&view)?;
        self.view = view;
        self.scene.clone_from(scene);
        Ok(())
    }

    /// Chooses the pixels that the next frames draw, row 0 on top; `None` for all. Others hold the
    /// background, or what is found on the way. In the compute stage nothing is traced for tiles
    /// without chosen pixels.
    ///
    /// # Errors
    /// [`ErrorKind::Usage`] for another number of pixels, and in the fragment stage.
    pub fn open(&mut self, pixels: Option<&[bool]>) -> Result<()> {
        let size = (self.settings.width, self.settings.height);
        let fits = pixels.is_none_or(|all| all.len() == pixel_count(size.0, size.1).unwrap_or(0));
        if !fits || self.settings.stage != DrawStage::Compute {
            let message = "a choice of pixels has one for each, in the stage compute";
            return Err(Error::new(ErrorKind::Usage, message));
        }
        let open = pixels.map(|all| OpenPixels::new(size.0, all));
        self.renderer.set_open_pixels(open);
        Ok(())
    }

    /// The renderer of the scene: draw paths, costs and notes since the last update that succeeded.
    #[must_use]
    pub fn renderer(&self) -> &Renderer {
        &self.renderer
    }

    /// The pass for a guest's pipelines; null in compute. The pass lives as long as `self`; those of
    /// equal planes and samples are compatible.
    #[must_use]
    pub fn render_pass(&self) -> vk::RenderPass {
        self.target.pass
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
        let (settings, background) = (&self.settings, self.scene.background);
        let planes = self.target.read(&self.commands)?;
        if !settings.antialias {
            return read_back::frame(settings, background, &planes);
        }
        let camera = CameraFrame::new(&self.scene.camera, settings.width, settings.height)?;
        self.solids.update(&self.scene);
        let by = (&self.solids, &camera);
        read_back::smoothed(settings, background, &planes, by, &self.view)
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
        host_memory::collected(colors.as_chunks().0.iter().copied(), "a picture of 8 bits")
    }

    pub(crate) fn check_whole(&self) -> Result<()> {
        if !self.whole {
            return Err(Error::new(
                ErrorKind::Usage,
                "the last update failed half way; update again with what can be drawn, or make a new one",
            ));
        }
        Ok(())
    }
}
