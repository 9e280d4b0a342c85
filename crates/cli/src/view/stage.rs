//! The scene's renderer and the controls, drawn in one pass.
#![allow(unsafe_code)] // raw handles: each use says what it promises

use super::frames::FRAMES;
use super::scene_renderer::SceneRenderer;
use super::screen::{Before, DEPTH, Screen};
use super::shown::Shown;
use super::times::Cost;
use super::traced::Traced;
use super::vulkan::Vulkan;
use ash::vk;
use egui::FullOutput;
use egui_ash_renderer::allocator::GpuAllocator;
use egui_ash_renderer::{DynamicRendering, Options, RenderMode, Renderer as Gui};
use revmap::error::{self, Error, Result};
use revmap::gpu::{Device, DrawPath, View};
use revmap::scene::Camera;
use revmap::settings::DrawStage;
use revmap_files::Picture;
use std::rc::Rc;
use std::time::Instant;
use winit::window::Window;

/// All objects for drawing. Fields are dropped in order, the device last.
pub struct Stage {
    gui: Gui<GpuAllocator>,
    drawn: SceneRenderer,
    /// The device of the renderer, and of others that draw with the same shaders.
    pub device: Device,
    /// The target of the compute stage; `None` in the fragment stage, or without pictures.
    traced: Option<Traced>,
    screen: Screen,
    compiled: u64,
    /// Textures of the controls to be freed after the next frame.
    freed: Vec<egui::TextureId>,
    pub host: Rc<Vulkan>,
}

/// A frame that was shown.
pub struct Frame {
    pub cost: Cost,
    /// True if the window has another size now.
    pub stale: bool,
    /// The picture, if it was requested.
    pub picture: Option<Picture>,
}

fn gui_error(error: impl std::fmt::Display) -> Error {
    Error::new(
        error::ErrorKind::Other,
        format!("the controls cannot be drawn: {error}"),
    )
}

impl Stage {
    pub fn new(window: &Window, choice: Option<&str>, shown: &Shown) -> Result<Self> {
        let host = Rc::new(Vulkan::open(window, choice)?);
        let size = window.inner_size();
        let screen = Screen::new(&host, (size.width, size.height))?;
        let mode = RenderMode::DynamicRendering(DynamicRendering {
            color_attachment_format: screen.format(),
            depth_attachment_format: Some(DEPTH),
            stencil_attachment_format: None,
        });
        let options = Options {
            in_flight_frames: FRAMES,
            srgb_framebuffer: true,
            ..Options::default()
        };
        let gui = Gui::with_gpu_allocator(
            host.allocator()?.clone(),
            host.device.clone(),
            mode,
            options,
        )
        .map_err(gui_error)?;
        let device = host.lend(None)?;
        let by = (shown.stage, shown.search);
        let mut stage = Self {
            gui,
            drawn: SceneRenderer::new(&device, screen.format(), by)?,
            device,
            traced: None,
            screen,
            compiled: 0,
            freed: Vec::new(),
            host,
        };
        stage.aim()?;
        stage.set(shown)?;
        stage.drawn.renderer.prewarm()?.compile()?;
        stage.compiled = stage.device.pipelines_compiled();
        Ok(stage)
    }

    /// Updates the renderer to the shown state. A failing part leaves the rest unchanged.
    pub fn set(&mut self, shown: &Shown) -> Result<()> {
        let by = (shown.stage, shown.search);
        if self.drawn.by != by {
            let drawn = SceneRenderer::new(&self.device, self.screen.format(), by)?;
            self.replace(drawn)?;
        }
        self.drawn.set(&shown.scene)
    }

    /// Draws with another renderer, made on another device with other shaders.
    pub fn take(&mut self, (device, drawn): (Device, SceneRenderer)) -> Result<()> {
        self.replace(drawn)?;
        self.device = device;
        self.compiled = self.device.pipelines_compiled();
        Ok(())
    }

    fn replace(&mut self, drawn: SceneRenderer) -> Result<()> {
        self.host.wait();
        self.drawn = drawn;
        self.aim()
    }

    /// The format of the window's pictures.
    pub fn format(&self) -> vk::Format {
        self.screen.format()
    }

    pub fn resize(&mut self, size: (u32, u32)) -> Result<()> {
        self.screen.resize(size)?;
        self.aim()
    }

    /// Makes a target of the window's size for the compute stage. The device must be idle.
    fn aim(&mut self) -> Result<()> {
        self.traced = None;
        let extent = self.screen.extent();
        if self.drawn.by.0 == DrawStage::Compute && extent.width > 0 && extent.height > 0 {
            let traced = Traced::new(&self.host, extent)?;
            // SAFETY: it is of the host's device and has the size of every view, and lives until
            // another one is set, for which the device is waited for.
            unsafe { self.drawn.renderer.set_compute_target(traced.target()) }?;
            self.traced = Some(traced);
        }
        Ok(())
    }

    /// The draw path of each object in the last frame.
    pub fn draw_paths(&self) -> Vec<DrawPath> {
        self.drawn.renderer.draw_paths()
    }

    /// Draws a frame: the scene with this camera and background, then the controls. The controls
    /// may bring a picture in place of the scene. Returns `None` if the window has another size. A
    /// scene that cannot be drawn is left out, and `problem` gets the reason.
    pub fn draw(
        &mut self,
        scene: Option<(&Camera, [f32; 4])>,
        mut gui: FullOutput,
        context: &egui::Context,
        keep: bool,
        problem: &mut Option<String>,
    ) -> Result<Option<Frame>> {
        self.take_textures(&mut gui)?;
        let Some(frame) = self.screen.begin()? else {
            return Ok(None);
        };
        let device = self.screen.frames.device_ms(frame.slot).unwrap_or(0.0);
        let start = Instant::now();
        let extent = self.screen.extent();
        let prepared = scene.map(|(camera, _)| {
            let distance = (camera.eye - camera.target).length();
            let range = [0.01 * distance, 100.0 * distance];
            let view = View::from_camera(camera, (extent.width, extent.height), range)?;
            // SAFETY: the slot was waited for; the commands are recording outside of the pass.
            unsafe {
                self.drawn
                    .renderer
                    .prepare(frame.commands, frame.slot, &view)
            }
        });
        let draws = match prepared {
            Some(Err(error)) => {
                *problem = Some(error.to_string());
                None
            }
            Some(Ok(prepared)) => Some(prepared),
            None => None,
        };
        let background = scene.map_or([0.0; 4], |(_, background)| background);
        let (renderer, commands) = (&self.drawn.renderer, frame.commands);
        match (&self.traced, &draws) {
            (Some(traced), Some(prepared)) => {
                // SAFETY: the slot was prepared, the commands are recording outside of a pass; what
                // is drawn into has the window's size.
                unsafe {
                    traced.clear(commands, background);
                    renderer.record_compute(commands, prepared)?;
                    traced.show(commands, self.screen.picture(frame));
                }
                self.screen.begin_pass(frame, Before::Kept);
            }
            _ => {
                self.screen.begin_pass(frame, Before::Cleared(background));
                if let Some(prepared) = &draws {
                    // SAFETY: the slot was prepared, the pass is of the output's formats.
                    unsafe { renderer.record(commands, prepared) }?;
                }
            }
        }
        let primitives = context.tessellate(gui.shapes, gui.pixels_per_point);
        let drawn = self
            .gui
            .cmd_draw(frame.commands, extent, gui.pixels_per_point, &primitives);
        drawn.map_err(gui_error)?;
        let prepare = milliseconds(start);
        let start = Instant::now();
        let (fits, picture) = self.screen.finish(frame, keep)?;
        let compiled = self.device.pipelines_compiled();
        let cost = Cost {
            prepare,
            device,
            present: milliseconds(start),
            compiled: compiled - self.compiled,
        };
        self.compiled = compiled;
        self.free_textures()?;
        Ok(Some(Frame {
            cost,
            stale: !fits,
            picture,
        }))
    }

    fn free_textures(&mut self) -> Result<()> {
        if !self.freed.is_empty() {
            self.host.wait();
        }
        for id in self.freed.drain(..) {
            self.gui.free_texture(id).map_err(gui_error)?;
        }
        Ok(())
    }

    fn take_textures(&mut self, gui: &mut FullOutput) -> Result<()> {
        let delta = &mut gui.textures_delta;
        self.freed.extend(delta.free.drain());
        if !delta.set.is_empty() {
            // Frames in flight may read the replaced texture.
            self.host.wait();
        }
        let (queue, pool) = (self.host.queue, self.screen.frames.pool);
        for (id, deltas) in delta.set.drain() {
            for delta in deltas {
                let set = self.gui.set_texture(queue, pool, id, &delta);
                set.map_err(gui_error)?;
            }
        }
        Ok(())
    }
}

impl Drop for Stage {
    fn drop(&mut self) {
        self.host.wait();
    }
}

fn milliseconds(since: Instant) -> f64 {
    since.elapsed().as_secs_f64() * 1e3
}
