//! The window's events.

use super::controls::{self, Asked, Shown};
use super::stage::Stage;
use super::times::Times;
use super::{View, orbit};
use crate::output;
use revmap::error::{Error, Result, Stage as Where};
use revmap::scene::file::SceneFile;
use std::path::Path;
use std::sync::Arc;
use std::time::{Duration, Instant};
use winit::application::ApplicationHandler;
use winit::dpi::PhysicalSize;
use winit::event::{ElementState, MouseButton, MouseScrollDelta, WindowEvent};
use winit::event_loop::{ActiveEventLoop, ControlFlow};
use winit::window::{Window, WindowId};

/// Changes that can be undone.
const UNDOS: usize = 100;
/// Longer pauses of the controls than this are none.
const SOON: Duration = Duration::from_secs(5);

/// The window and what is in it. The stage goes before the window.
struct Open {
    stage: Stage,
    gui: egui_winit::State,
    window: Arc<Window>,
}

pub struct App {
    options: View,
    first: Shown,
    shown: Shown,
    undo: Vec<Shown>,
    /// Whether a change is going on that is one for undoing, as a slider is dragged.
    changing: bool,
    open: Option<Open>,
    times: Times,
    problem: Option<String>,
    pointer: [f64; 2],
    held: Option<MouseButton>,
    drawn: u32,
    ended: Result<()>,
}

impl App {
    pub fn new(options: View, shown: Shown) -> Self {
        Self {
            options,
            first: shown.clone(),
            shown,
            undo: Vec::new(),
            changing: false,
            open: None,
            times: Times::default(),
            problem: None,
            pointer: [0.0; 2],
            held: None,
            drawn: 0,
            ended: Ok(()),
        }
    }

    /// What the window ended with.
    pub fn end(mut self) -> Result<()> {
        let checked = self.open.take().map_or(Ok(()), |open| {
            let host = open.stage.host.clone();
            drop(open);
            host.check()
        });
        self.ended.and(checked)
    }

    fn open(&self, events: &ActiveEventLoop) -> Result<Open> {
        let (width, height) = self.options.size;
        let attributes = Window::default_attributes()
            .with_title(format!("revmap: {}", self.options.scene.display()))
            .with_inner_size(PhysicalSize::new(width, height));
        let window = events.create_window(attributes);
        let window = window.map_err(|e| Error::new(Where::Device, format!("no window: {e}")))?;
        let stage = Stage::new(&window, self.options.device.as_deref(), &self.shown)?;
        let scale = window.scale_factor() as f32;
        let id = egui::ViewportId::ROOT;
        let gui = egui_winit::State::new(
            egui::Context::default(),
            id,
            &window,
            Some(scale),
            None,
            None,
        );
        Ok(Open {
            stage,
            gui,
            window: Arc::new(window),
        })
    }

    /// Draws a frame. Gives when the next is wanted, if no event comes.
    fn frame(&mut self) -> Result<Option<Duration>> {
        let Some(open) = &mut self.open else {
            return Ok(None);
        };
        let size = open.window.inner_size();
        if size.width == 0 || size.height == 0 {
            return Ok(None); // minimised
        }
        let input = open.gui.take_egui_input(&open.window);
        let context = open.gui.egui_ctx().clone();
        let before = self.shown.clone();
        let mut asked = Asked::default();
        let (shown, times, problem, undos) = (
            &mut self.shown,
            &self.times,
            self.problem.as_deref(),
            self.undo.len(),
        );
        let mut output = context.run_ui(input, |ui| {
            egui::Window::new("revmap")
                .default_pos([8.0, 8.0])
                .default_size([300.0, 640.0])
                .vscroll(true)
                .show(ui.ctx(), |ui| {
                    asked = controls::show(ui, shown, times, problem, undos)
                });
        });
        self.take(asked, before);
        let open = match &mut self.open {
            Some(open) => open,
            None => return Ok(None),
        };
        if self.changing && !context.input(|i| i.pointer.any_down()) {
            self.changing = false;
        }
        if asked != Asked::default() {
            self.problem = None;
        }
        if let Err(error) = open.stage.set(&self.shown) {
            self.problem = Some(error.to_string());
        }
        let platform = std::mem::take(&mut output.platform_output);
        open.gui.handle_platform_output(&open.window, platform);
        let root = output.viewport_output.get(&egui::ViewportId::ROOT);
        let pause = root.map_or(Duration::MAX, |v| v.repaint_delay);
        let last = self.options.frames == Some(self.drawn + 1);
        let keep = last && self.options.screenshot.is_some();
        let drawn = open
            .stage
            .draw(&self.shown, output, &context, keep, &mut self.problem)?;
        let stale = drawn.as_ref().is_none_or(|frame| frame.stale);
        if stale {
            open.stage.resize((size.width, size.height))?;
            open.window.request_redraw();
        }
        if let Some(frame) = drawn {
            self.times.push(frame.cost);
            self.drawn += 1;
            if let (Some(picture), Some(file)) = (frame.picture, &self.options.screenshot) {
                picture.write_png(file)?;
                output::result(&format!("{}: frame {}", file.display(), self.drawn));
            }
        }
        Ok(Some(pause))
    }

    /// Does what the controls ask for.
    fn take(&mut self, asked: Asked, before: Shown) {
        if asked.undo {
            if let Some(shown) = self.undo.pop() {
                self.shown = shown;
            }
        } else if asked.reset {
            self.undo.push(before);
            self.shown = self.first.clone();
        } else if asked.changed && !self.changing {
            self.undo.push(before);
            self.changing = true;
        }
        if self.undo.len() > UNDOS {
            self.undo.remove(0);
        }
    }

    /// Shows what was dropped on the window.
    fn load(&mut self, file: &Path) {
        match SceneFile::open(file).and_then(|mut file| file.scene(&[])) {
            Ok(scene) => {
                self.undo.push(self.shown.clone());
                self.shown.scene = scene;
                self.first = self.shown.clone();
            }
            Err(error) => self.problem = Some(error.to_string()),
        }
    }

    fn drag(&mut self, to: [f64; 2]) {
        let by = [to[0] - self.pointer[0], to[1] - self.pointer[1]];
        self.pointer = to;
        let height = self
            .open
            .as_ref()
            .map_or(1, |open| open.window.inner_size().height);
        let camera = &mut self.shown.scene.camera;
        match self.held {
            Some(MouseButton::Left) => orbit::turn(camera, by),
            Some(_) => orbit::shift(camera, by, f64::from(height)),
            None => {}
        }
    }

    fn fail(&mut self, events: &ActiveEventLoop, error: Error) {
        self.ended = Err(error);
        events.exit();
    }
}

impl ApplicationHandler for App {
    fn resumed(&mut self, events: &ActiveEventLoop) {
        if self.open.is_some() {
            return;
        }
        match self.open(events) {
            Ok(open) => {
                open.window.request_redraw();
                self.open = Some(open);
            }
            Err(error) => self.fail(events, error),
        }
    }

    fn window_event(&mut self, events: &ActiveEventLoop, _: WindowId, event: WindowEvent) {
        let Some(open) = &mut self.open else {
            return;
        };
        let window = open.window.clone();
        let answer = open.gui.on_window_event(&window, &event);
        // It answers so to a frame, too, which would never let the window rest.
        if answer.repaint && !matches!(event, WindowEvent::RedrawRequested) {
            window.request_redraw();
        }
        match event {
            WindowEvent::CloseRequested => events.exit(),
            WindowEvent::Resized(size) if size.width > 0 && size.height > 0 => {
                if let Err(error) = open.stage.resize((size.width, size.height)) {
                    self.fail(events, error);
                }
                window.request_redraw();
            }
            WindowEvent::DroppedFile(file) => {
                self.load(&file);
                window.request_redraw();
            }
            WindowEvent::CursorMoved { position, .. } => {
                self.drag([position.x, position.y]);
                if self.held.is_some() {
                    window.request_redraw();
                }
            }
            WindowEvent::MouseInput { state, button, .. } => {
                let pressed = state == ElementState::Pressed && !answer.consumed;
                self.held = pressed.then_some(button);
            }
            WindowEvent::MouseWheel { delta, .. } if !answer.consumed => {
                let steps = match delta {
                    MouseScrollDelta::LineDelta(_, lines) => f64::from(lines),
                    MouseScrollDelta::PixelDelta(pixels) => pixels.y / 50.0,
                };
                orbit::zoom(&mut self.shown.scene.camera, steps);
                window.request_redraw();
            }
            WindowEvent::RedrawRequested => match self.frame() {
                Err(error) => self.fail(events, error),
                Ok(_) if self.options.frames.is_some_and(|n| self.drawn >= n) => events.exit(),
                Ok(_) if self.options.frames.is_some() => window.request_redraw(),
                Ok(Some(Duration::ZERO)) => window.request_redraw(),
                Ok(Some(pause)) if pause < SOON => {
                    events.set_control_flow(ControlFlow::WaitUntil(Instant::now() + pause))
                }
                Ok(_) => events.set_control_flow(ControlFlow::Wait),
            },
            _ => {}
        }
    }

    /// A pause of the controls has ended.
    fn new_events(&mut self, events: &ActiveEventLoop, cause: winit::event::StartCause) {
        if let (winit::event::StartCause::ResumeTimeReached { .. }, Some(open)) =
            (cause, &self.open)
        {
            events.set_control_flow(ControlFlow::Wait);
            open.window.request_redraw();
        }
    }
}
