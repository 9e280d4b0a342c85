//! The window's events.

use super::View;
use super::actions::Change;
use super::framing::Framing;
use super::inspect::Inspector;
#[cfg(feature = "shaderc")]
use super::reload::Reload;
use super::saved;
use super::shown::Shown;
use super::stage::Stage;
use super::times::Times;
use revmap::error::{self, Error, Result};
use revmap_files::SceneFile;
use std::path::{Path, PathBuf};
use std::rc::Rc;
use std::time::{Duration, Instant};
use winit::application::ApplicationHandler;
use winit::dpi::PhysicalSize;
use winit::event::{ElementState, MouseButton, MouseScrollDelta, WindowEvent};
use winit::event_loop::{ActiveEventLoop, ControlFlow, EventLoopProxy};
use winit::window::{Window, WindowId};

/// Longer delays from the controls are ignored.
const SOON: Duration = Duration::from_secs(5);

/// The window and its contents. The stage is dropped before the window, and objects made on its
/// device before the stage.
pub(super) struct Open {
    pub inspector: Inspector,
    #[cfg(feature = "shaderc")]
    pub reload: Option<Reload>,
    pub stage: Stage,
    pub gui: egui_winit::State,
    pub window: Rc<Window>,
}

pub struct App {
    pub(super) options: View,
    /// Requests a frame from another thread.
    pub(super) wake: EventLoopProxy<()>,
    /// The file of the shown scene.
    pub(super) source: PathBuf,
    pub(super) file: SceneFile,
    pub(super) first: Shown,
    pub(super) shown: Shown,
    /// Counts changes of the shown state.
    pub(super) version: u64,
    pub(super) undo: Vec<Shown>,
    /// The change in progress: all of it is undone at once.
    pub(super) changing: Option<Change>,
    pub(super) open: Option<Open>,
    pub(super) times: Times,
    pub(super) problem: Option<String>,
    /// Report of the last written file, until the next change.
    pub(super) written: String,
    /// True to write the next frame as a picture.
    pub(super) keep: bool,
    pub(super) panel: bool,
    pub(super) help: bool,
    /// True until the help has been shown.
    pub(super) hint: bool,
    /// True to close the window.
    pub(super) quit: bool,
    /// The framing of the last frame.
    pub(super) framing: Framing,
    pub(super) pointer: [f64; 2],
    pub(super) held: Option<MouseButton>,
    pub(super) drawn: u32,
    ended: Result<()>,
}

impl App {
    pub fn new(options: View, file: SceneFile, shown: Shown, wake: EventLoopProxy<()>) -> Self {
        let mut times = Times::default();
        times.kept = options.times.is_some().then(Vec::new);
        Self {
            source: options.scene.clone(),
            options,
            wake,
            file,
            first: shown.clone(),
            shown,
            version: 0,
            undo: Vec::new(),
            changing: None,
            open: None,
            times,
            problem: None,
            written: String::new(),
            keep: false,
            panel: true,
            help: false,
            hint: true,
            quit: false,
            framing: Framing::default(),
            pointer: [0.0; 2],
            held: None,
            drawn: 0,
            ended: Ok(()),
        }
    }

    /// The result of the window.
    pub fn end(mut self) -> Result<()> {
        let checked = self.open.take().map_or(Ok(()), |open| {
            let host = open.stage.host.clone();
            drop(open);
            host.check()
        });
        if let (Some(path), Some(kept)) = (&self.options.times, &self.times.kept) {
            saved::write_times(path, kept)?;
        }
        self.ended.and(checked)
    }

    fn open(&self, events: &ActiveEventLoop) -> Result<Open> {
        let (width, height) = self.options.size;
        let attributes = Window::default_attributes()
            .with_title(title(&self.source))
            .with_inner_size(PhysicalSize::new(width, height));
        let window = events.create_window(attributes);
        let window = window
            .map_err(|e| Error::new(error::ErrorKind::Unsupported, format!("no window: {e}")))?;
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
        #[cfg(feature = "shaderc")]
        let reload = self.options.watch_shaders.as_deref();
        Ok(Open {
            inspector: Inspector::default(),
            #[cfg(feature = "shaderc")]
            reload: reload.map(|folder| Reload::new(folder, self.wake.clone())),
            stage,
            gui,
            window: Rc::new(window),
        })
    }

    fn fail(&mut self, events: &ActiveEventLoop, error: Error) {
        self.ended = Err(error);
        events.exit();
    }
}

/// The title of a window that shows this file.
pub(super) fn title(source: &Path) -> String {
    format!("revmap: {}", source.display())
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
        // The answer to `RedrawRequested` also requests a repaint, which would redraw the window
        // forever.
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
                self.zoom(steps);
                window.request_redraw();
            }
            WindowEvent::RedrawRequested => match self.frame() {
                Err(error) => self.fail(events, error),
                Ok(_) if self.quit => events.exit(),
                Ok(None) => events.set_control_flow(ControlFlow::Wait),
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

    /// Handles a wake-up from another thread.
    fn user_event(&mut self, _: &ActiveEventLoop, (): ()) {
        if let Some(open) = &self.open {
            open.window.request_redraw();
        }
    }

    /// Handles the end of a delay of the controls.
    fn new_events(&mut self, events: &ActiveEventLoop, cause: winit::event::StartCause) {
        if let (winit::event::StartCause::ResumeTimeReached { .. }, Some(open)) =
            (cause, &self.open)
        {
            events.set_control_flow(ControlFlow::Wait);
            open.window.request_redraw();
        }
    }
}
