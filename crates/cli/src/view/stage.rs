//! What the window shows: the scene's renderer and the controls, in one pass.
#![allow(unsafe_code)] // raw handles: each use says what it promises

use super::shown::Shown;
use super::swapchain::{Begun, DEPTH, FRAMES, Swapchain};
use super::times::Cost;
use super::vulkan::Vulkan;
use egui::FullOutput;
use egui_ash_renderer::allocator::GpuAllocator;
use egui_ash_renderer::{DynamicRendering, Options, RenderMode, Renderer as Gui};
use revmap::error::{Error, Result, Stage as Where};
use revmap::frame::Picture;
use revmap::gpu::{DepthOrder, DrawPath, ObjectId, Output, PassFormats, PassKind, Renderer, View};
use revmap::scene::Scene;
use revmap::settings::{Planes, SearchSettings};
use std::rc::Rc;
use std::time::Instant;
use winit::window::Window;

/// Everything that is drawn with. Fields go in order; the device goes last.
pub struct Stage {
    gui: Gui<GpuAllocator>,
    renderer: Renderer,
    ids: Vec<ObjectId>,
    search: SearchSettings,
    swapchain: Swapchain,
    compiled: u64,
    /// Textures of the controls that go after the next frame.
    freed: Vec<egui::TextureId>,
    pub host: Rc<Vulkan>,
}

/// A frame that was shown.
pub struct Frame {
    pub cost: Cost,
    /// Whether the window has another size now.
    pub stale: bool,
    /// What it looked like, where that was asked for.
    pub picture: Option<Picture>,
}

fn gui_error(error: impl std::fmt::Display) -> Error {
    Error::new(
        Where::Draw,
        format!("the controls cannot be drawn: {error}"),
    )
}

impl Stage {
    pub fn new(window: &Window, choice: Option<&str>, shown: &Shown) -> Result<Self> {
        let host = Rc::new(Vulkan::open(window, choice)?);
        let size = window.inner_size();
        let swapchain = Swapchain::new(&host, (size.width, size.height))?;
        let shared = host.shared()?;
        let mode = RenderMode::DynamicRendering(DynamicRendering {
            color_attachment_format: swapchain.format.format,
            depth_attachment_format: Some(DEPTH),
            stencil_attachment_format: None,
        });
        let options = Options {
            in_flight_frames: FRAMES,
            srgb_framebuffer: true,
            ..Options::default()
        };
        let gui = Gui::with_gpu_allocator(shared.allocator()?, host.device.clone(), mode, options)
            .map_err(gui_error)?;
        let mut stage = Self {
            gui,
            renderer: renderer(&host, &swapchain, &shown.search)?,
            ids: Vec::new(),
            search: shown.search,
            swapchain,
            compiled: 0,
            freed: Vec::new(),
            host: host.clone(),
        };
        stage.set(shown)?;
        stage.renderer.prewarm()?.compile()?;
        stage.compiled = shared.pipelines_compiled();
        Ok(stage)
    }

    /// Takes over what is shown. What fails leaves the rest as it was.
    pub fn set(&mut self, shown: &Shown) -> Result<()> {
        if self.search != shown.search {
            self.host.wait();
            self.renderer = renderer(&self.host, &self.swapchain, &shown.search)?;
            self.search = shown.search;
            self.ids.clear();
        }
        self.renderer.set_lighting(&shown.scene.lighting())?;
        let objects = &shown.scene.objects;
        while self.ids.len() > objects.len() {
            if let Some(id) = self.ids.pop() {
                self.renderer.remove(id)?;
            }
        }
        for (n, object) in objects.iter().enumerate() {
            match self.ids.get(n) {
                Some(&id) => self.renderer.set(id, object.clone())?,
                None => self.ids.push(self.renderer.add(object.clone())?),
            }
        }
        Ok(())
    }

    pub fn resize(&mut self, size: (u32, u32)) -> Result<()> {
        self.swapchain.resize(size)
    }

    /// How each object was drawn in the last frame.
    pub fn draw_paths(&self) -> Vec<DrawPath> {
        self.renderer.draw_paths()
    }

    /// Draws a frame: the scene, unless the controls bring a picture of their own, then the
    /// controls. None: the window has another size. A scene that cannot be drawn is left out, and
    /// told to `problem`.
    pub fn draw(
        &mut self,
        scene: Option<&Scene>,
        mut gui: FullOutput,
        context: &egui::Context,
        keep: bool,
        problem: &mut Option<String>,
    ) -> Result<Option<Frame>> {
        self.take_textures(&mut gui)?;
        let Begun::Frame(frame) = self.swapchain.begin()? else {
            return Ok(None);
        };
        let device = self.swapchain.device_ms(frame.slot).unwrap_or(0.0);
        let start = Instant::now();
        let extent = self.swapchain.extent;
        let prepared = scene.map(|scene| {
            let camera = &scene.camera;
            let distance = (camera.eye - camera.target).length();
            let range = [0.01 * distance, 100.0 * distance];
            let view = View::from_camera(camera, (extent.width, extent.height), range)?;
            // SAFETY: the slot was waited for; the commands are recording outside of the pass.
            unsafe { self.renderer.prepare(frame.commands, frame.slot, &view) }
        });
        let background = scene.map_or([0.0; 4], |scene| scene.background);
        self.swapchain.begin_pass(frame, background);
        match prepared {
            // SAFETY: the slot was prepared, the pass is of the output's formats.
            Some(Ok(())) => unsafe { self.renderer.record(frame.commands, frame.slot) },
            Some(Err(error)) => *problem = Some(error.to_string()),
            None => {}
        }
        let primitives = context.tessellate(gui.shapes, gui.pixels_per_point);
        let drawn = self
            .gui
            .cmd_draw(frame.commands, extent, gui.pixels_per_point, &primitives);
        drawn.map_err(gui_error)?;
        let prepare = milliseconds(start);
        let start = Instant::now();
        let (fits, picture) = self.swapchain.finish(frame, keep)?;
        let compiled = self.host.shared()?.pipelines_compiled();
        let cost = Cost {
            prepare,
            device,
            present: milliseconds(start),
            compiled: compiled - self.compiled,
        };
        self.compiled = compiled;
        if !self.freed.is_empty() {
            self.host.wait();
            for id in self.freed.drain(..) {
                self.gui.free_texture(id).map_err(gui_error)?;
            }
        }
        Ok(Some(Frame {
            cost,
            stale: !fits,
            picture,
        }))
    }

    fn take_textures(&mut self, gui: &mut FullOutput) -> Result<()> {
        let delta = &mut gui.textures_delta;
        self.freed.extend(delta.free.drain());
        if !delta.set.is_empty() {
            // Frames in flight may read what is replaced.
            self.host.wait();
        }
        let (queue, pool) = (self.host.queue, self.swapchain.pool());
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

fn renderer(host: &Vulkan, swapchain: &Swapchain, search: &SearchSettings) -> Result<Renderer> {
    let output = Output::Pass(PassFormats {
        begun: PassKind::Dynamic {
            color: vec![swapchain.format.format],
            depth: DEPTH,
            stencil: ash::vk::Format::UNDEFINED,
        },
        samples: 1,
        depth: DepthOrder::Normal,
        planes: Planes::Color,
    });
    Renderer::new(host.shared()?, output, search, FRAMES)
}

fn milliseconds(since: Instant) -> f64 {
    since.elapsed().as_secs_f64() * 1e3
}
