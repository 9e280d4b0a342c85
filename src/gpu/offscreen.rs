//! Frames without a host: a target, commands, and reading back; the first user of [`Renderer`].

use crate::antialias::Solids;
use crate::error::{Error, ErrorKind, Result};
use crate::frame::Frame;
use crate::gpu::device::{Device, Shared};
use crate::gpu::frame::costs::ObjectCost;
use crate::gpu::frame::output::{Output, PassFormats, PassKind};
use crate::gpu::frame::read_back;
use crate::gpu::frame::target::Target;
use crate::gpu::object_id::ObjectId;
use crate::gpu::renderer::Renderer;
use crate::gpu::vk::clock::Clock;
use crate::gpu::vk::commands::Commands;
use crate::plan::{DepthOrder, DrawPath, View};
use crate::scene::{CameraFrame, Cluster, Growth, Object, Placement, Scene};
use crate::settings::{DrawStage, Planes, SearchSettings, Settings};
use ash::vk;
use glam::DVec3;
use std::f64::consts::SQRT_2;
use std::sync::Arc;
use std::time::Instant;

/// What one frame cost.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Times {
    /// Milliseconds that the CPU took to take over changes and to record.
    pub prepare_ms: f64,
    /// Milliseconds between GPU timestamps around the work; `None` where the device has none.
    pub gpu_ms: Option<f64>,
    /// Milliseconds from submission to completion by the wall clock.
    pub frame_ms: f64,
}

/// A scene on a device and a picture that it is drawn into.
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
    /// Whether a guest draws the scene's objects.
    guests_only: bool,
    /// What silhouettes are smoothed by, where they are.
    solids: Option<(Solids, CameraFrame)>,
    /// From the first thing that an update changes to the last: what one that failed in between has
    /// left must not be drawn.
    stale: bool,
    /// Null in compute.
    pass: vk::RenderPass,
    device: Arc<Shared>,
}

/// Something else that is drawn in an off-screen frame's pass, into the same depth buffer.
pub trait Guest {
    /// Records what its draws need beforehand, such as copies into its buffers. It is not timed.
    ///
    /// # Safety
    /// `cmd` is recording, outside of a pass. What is recorded must stay valid until the frame was
    /// drawn.
    unsafe fn prepare(&self, _cmd: vk::CommandBuffer) {}

    /// Records its draws.
    ///
    /// # Safety
    /// `cmd` is recording, within the pass of [`Offscreen::render_pass`], viewport and scissor set.
    /// What is recorded must stay valid until the frame was drawn.
    unsafe fn record(&self, cmd: vk::CommandBuffer);
}

impl Offscreen {
    /// Bakes and uploads the scene's maps and makes a target of the settings' size. Pipelines are
    /// compiled by the first frame.
    ///
    /// # Errors
    /// Of baking and of the scene's values ([`ErrorKind::Content`]); [`ErrorKind::TooLarge`] for
    /// more pixels than the device takes; of Vulkan.
    pub fn new(device: &Device, scene: &Scene, settings: &Settings) -> Result<Self> {
        Self::open(device, scene, settings, false)
    }

    /// As [`Offscreen::new`], but without the scene's objects, now and in every update: a guest
    /// draws them. Camera, background, lights and the range of depths are the scene's.
    ///
    /// # Errors
    /// As `new`.
    pub fn for_guests(device: &Device, scene: &Scene, settings: &Settings) -> Result<Self> {
        Self::open(device, scene, settings, true)
    }

    fn open(
        device: &Device,
        scene: &Scene,
        settings: &Settings,
        guests_only: bool,
    ) -> Result<Self> {
        if matches!(settings.planes, Planes::Depth { .. }) {
            let message = "depth alone is drawn in a host's pass; give color or all";
            return Err(Error::new(ErrorKind::Usage, message));
        }
        let size = (settings.width, settings.height);
        let view = view_of(scene, size)?;
        // Distances are among all planes.
        let keeps_depths = settings.antialias && settings.planes == Planes::Color;
        let shared = device.shared.clone();
        let commands = Commands::new(&shared)?;
        let raw = match settings.stage {
            DrawStage::Compute => vk::RenderPass::null(),
            _ => shared
                .pipelines()?
                .own_pass(settings.planes, keeps_depths)?,
        };
        let target = Target::new(
            &shared,
            raw,
            settings.stage,
            settings.planes,
            keeps_depths,
            size,
        )?;
        let output = match settings.stage {
            DrawStage::Compute => Output::Compute(settings.planes),
            _ => Output::Pass(PassFormats {
                begun: PassKind::RenderPass {
                    pass: raw,
                    subpass: 0,
                },
                samples: 1,
                depth: DepthOrder::Normal,
                planes: settings.planes,
            }),
        };
        let mut renderer = Renderer::new(device, output, &SearchSettings::from(settings), 1)?;
        if let Some(target) = target.for_shaders() {
            // SAFETY: the target is of this device and of the size of all views; it is dropped after
            // the renderer.
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
            pass: raw,
            device: shared,
        };
        offscreen.update(scene)?;
        Ok(offscreen)
    }

    /// Takes over a scene: camera, lights, objects, more or fewer of them. Cost follows what
    /// differs from the scene before.
    ///
    /// # Errors
    /// [`ErrorKind::Content`] for the scene's values, profiles and maps: what was drawn before can
    /// be drawn on. Of Vulkan: nothing is drawn before an update succeeds.
    pub fn update(&mut self, scene: &Scene) -> Result<()> {
        scene.check()?;
        let view = view_of(scene, (self.settings.width, self.settings.height))?;
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

    /// All or nothing: what fails is taken back.
    fn apply(&mut self, scene: &Scene, view: &View) -> Result<()> {
        let lighting = scene.lighting();
        let before = self.renderer.lighting().clone();
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
            // What never was drawn has nothing to go back to.
            if there > 0 {
                self.renderer.plan(view)?;
            }
        }
        result
    }

    /// Compiles every pipeline that updates can come to need, as long as no object's technique
    /// changes ([`Renderer::prewarm`]), and has the driver run each on nothing, as some compile
    /// only then ([`Renderer::record_prewarm`]).
    ///
    /// # Errors
    /// Of Vulkan; [`ErrorKind::Usage`] after an update that has failed half way.
    pub fn prewarm(&mut self) -> Result<()> {
        self.check_whole()?;
        self.renderer.prewarm()?.compile()?;
        let compute = self.settings.stage == DrawStage::Compute;
        let Self {
            renderer, target, ..
        } = self;
        self.commands.record(|cmd| {
            // SAFETY: as in `draw_with`.
            unsafe {
                let frame = renderer.prepare(cmd, 0, &self.view)?;
                target.clear(cmd, self.background, frame.reads_depths());
                if compute {
                    return renderer.record_prewarm(cmd, &frame);
                }
                target.begin(cmd, self.pass, self.background);
                renderer.record_prewarm(cmd, &frame)?;
                self.device.raw.cmd_end_render_pass(cmd);
            }
            Ok(())
        })?;
        self.commands.submit_and_wait()
    }

    /// Draws one frame and waits for it.
    ///
    /// # Errors
    /// Of Vulkan; [`ErrorKind::Usage`] after an update that has failed half way.
    pub fn draw(&mut self) -> Result<Times> {
        self.draw_with(None)
    }

    /// Draws one frame with a guest in the same pass, after all objects, and waits for it. In
    /// compute there is no pass, and the guest is not asked.
    ///
    /// # Errors
    /// As [`Offscreen::draw`].
    pub fn draw_with(&mut self, guest: Option<&dyn Guest>) -> Result<Times> {
        self.check_whole()?;
        let start = Instant::now();
        let Self {
            renderer,
            target,
            commands,
            clock,
            view,
            background,
            ..
        } = self;
        let (compute, pass) = (self.settings.stage == DrawStage::Compute, self.pass);
        commands.record(|cmd| {
            // SAFETY: `cmd` is recording, and the frame before was waited for.
            let frame = unsafe { renderer.prepare(cmd, 0, view)? };
            if let (Some(guest), false) = (guest, compute) {
                // SAFETY: `cmd` is recording outside of a pass, and is waited for before this
                // returns.
                unsafe { guest.prepare(cmd) };
            }
            clock.start(cmd);
            target.clear(cmd, *background, frame.reads_depths());
            // SAFETY: the frame was prepared above; the target was cleared, the pass is of the
            // output's formats and sets viewport and scissor; the commands are waited for before
            // anything is dropped.
            unsafe {
                if compute {
                    renderer.record_compute(cmd, &frame)?;
                } else {
                    target.begin(cmd, pass, *background);
                    renderer.record(cmd, &frame)?;
                    if let Some(guest) = guest {
                        guest.record(cmd);
                    }
                    self.device.raw.cmd_end_render_pass(cmd);
                }
            }
            clock.stop(cmd);
            Ok(())
        })?;
        let prepare_ms = start.elapsed().as_secs_f64() * 1e3;
        let start = Instant::now();
        self.commands.submit_and_wait()?;
        let frame_ms = start.elapsed().as_secs_f64() * 1e3;
        Ok(Times {
            prepare_ms,
            gpu_ms: self.clock.milliseconds()?,
            frame_ms,
        })
    }

    /// The pass that a guest's pipelines are made for; null in compute. It lives as long as the
    /// device.
    #[must_use]
    pub fn render_pass(&self) -> vk::RenderPass {
        self.pass
    }

    /// The view of the last scene.
    #[must_use]
    pub fn view(&self) -> &View {
        &self.view
    }

    /// The frame that was drawn last.
    ///
    /// # Errors
    /// Of Vulkan; [`ErrorKind::Usage`] after an update that has failed half way.
    pub fn read(&mut self) -> Result<Frame> {
        self.check_whole()?;
        let planes = self.target.read(&self.commands)?;
        let (settings, background) = (&self.settings, self.background);
        match &self.solids {
            Some(by) => read_back::smoothed(settings, background, &planes, by, &self.view),
            None => read_back::frame(settings, background, &planes),
        }
    }

    /// As [`Renderer::map_bytes`].
    #[must_use]
    pub fn map_bytes(&self) -> [u64; 2] {
        self.renderer.map_bytes()
    }

    /// As [`Renderer::notes`].
    #[must_use]
    pub fn notes(&self) -> &[String] {
        self.renderer.notes()
    }

    /// As [`Renderer::draw_paths`], since the last update that succeeded.
    #[must_use]
    pub fn draw_paths(&self) -> Vec<DrawPath> {
        self.renderer.draw_paths()
    }

    /// As [`Renderer::object_costs`], since the last update that succeeded.
    #[must_use]
    pub fn object_costs(&self) -> Vec<ObjectCost> {
        self.renderer.object_costs()
    }

    /// As [`Renderer::device_bytes`]; the target is not among them.
    #[must_use]
    pub fn device_bytes(&self) -> u64 {
        self.renderer.device_bytes()
    }

    /// As [`Renderer::rebuild_count`].
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

/// The view of a scene's camera, with depths between which every box lies.
fn view_of(scene: &Scene, size: (u32, u32)) -> Result<View> {
    let camera = CameraFrame::new(&scene.camera, size.0, size.1)?;
    View::from_camera(&scene.camera, size, depth_range(scene, &camera))
}

/// Depths between which every box lies; near is never closer than a ten-thousandth of far.
fn depth_range(scene: &Scene, camera: &CameraFrame) -> [f64; 2] {
    let mut low = f64::INFINITY;
    let mut high: f64 = 0.0;
    for object in &scene.objects {
        // Corners of hulls stand out a little, those of convex ones by some texels more.
        let growth = Growth::of(object);
        let radius = 1.04 * (object.profile.radius + growth.side) + 0.02;
        let half = DVec3::new(radius, radius, 0.5 * growth.height() + 0.002);
        let middle_z = 0.5 * (1.0 + growth.high - growth.low);
        let range = |p: &Placement| {
            let middle = p.position + p.rotation * (p.scale * DVec3::new(0.0, 0.0, middle_z));
            let depth = (middle - camera.eye).dot(camera.forward);
            let reach = (p.rotation.conjugate() * camera.forward * p.scale)
                .abs()
                .dot(half);
            [depth - reach, depth + reach]
        };
        let farthest = [radius * SQRT_2, middle_z.abs() + half.z];
        let of = |cluster: &Cluster| cluster.around(camera.eye, farthest).along(camera.forward);
        low = low.min(object.least_of_copies(|c| of(c)[0], |p| range(p)[0]));
        high = high.max(-object.least_of_copies(|c| -of(c)[1], |p| -range(p)[1]));
    }
    if high <= 0.0 {
        return [1.0, 2.0];
    }
    let far = high * 1.001;
    [(low * 0.999).max(far * 1e-4), far]
}
