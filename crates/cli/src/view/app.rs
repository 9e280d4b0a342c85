//! The window: its events, its controls and its frames.

use super::controls::{self, Asked, Told};
use super::framing::Framing;
use super::picture::Painter;
use super::shown::{Change, Inspected, Shown};
use super::times::Times;
use super::{View, keys, overlay, saved, search_reload};
use crate::output;
use eframe::egui::{
    Color32, Context, Event, Id, MouseWheelUnit, Panel, PointerButton, Popup, RawInput, Rect,
    ScrollArea, Sense, Shape, Ui, Vec2, ViewportCommand, pos2,
};
use revmap::error::Result;
use revmap::settings::Solver;
use revmap_files::{Picture, SceneFile};
use revmap_searches::folder;
use std::path::{Path, PathBuf};
use std::sync::mpsc::Receiver;
use std::time::Instant;

/// Width of the panel at the start, points.
pub(super) const PANEL: f32 = 316.0;
/// Shown until the help has been shown.
const HINT: &str = "H: help";

pub struct App {
    pub(super) options: View,
    /// The file of the shown scene.
    pub(super) source: PathBuf,
    pub(super) file: SceneFile,
    pub(super) first: Shown,
    pub(super) shown: Shown,
    /// The shown state before the controls of this frame, and their requests.
    before: Shown,
    asked: Asked,
    /// Counts changes of the shown state.
    pub(super) version: u64,
    pub(super) undo: Vec<Shown>,
    /// The change in progress: all of it is undone at once.
    pub(super) changing: Option<Change>,
    pub(super) painter: Painter,
    /// The search of a folder, after each change of its files.
    search: Option<Receiver<Result<Solver>>>,
    times: Times,
    /// Time that the last frame took for its picture, milliseconds.
    drawing_ms: f64,
    pub(super) problem: Option<String>,
    /// Report of the last written file, until the next change.
    pub(super) written: String,
    /// True to write the next picture into a file.
    pub(super) keep: bool,
    pub(super) panel: bool,
    pub(super) help: bool,
    /// True until the help has been shown.
    pub(super) hint: bool,
    /// True to close the window.
    pub(super) quit: bool,
    /// The framing of the last frame.
    pub(super) framing: Framing,
    drawn: u32,
    ended: Result<()>,
}

impl App {
    pub fn new(options: View, file: SceneFile, shown: Shown) -> Result<Self> {
        let mut times = Times::default();
        times.kept = options.times.is_some().then(Vec::new);
        Ok(Self {
            painter: Painter::open(options.device.name(), &shown, options.size)?,
            source: options.input.scene.clone(),
            framing: Framing::new(options.size, 0),
            options,
            file,
            first: shown.clone(),
            before: shown.clone(),
            shown,
            asked: Asked::default(),
            version: 0,
            undo: Vec::new(),
            changing: None,
            search: None,
            times,
            drawing_ms: 0.0,
            problem: None,
            written: String::new(),
            keep: false,
            panel: true,
            help: false,
            hint: true,
            quit: false,
            drawn: 0,
            ended: Ok(()),
        })
    }

    /// Starts what needs the window's context.
    pub fn begin(&mut self, context: &Context) {
        self.search = search_reload::watch(self.options.solver, context.clone());
        let (width, height) = self.options.size;
        let size = Vec2::new(width as f32, height as f32) / context.pixels_per_point();
        context.send_viewport_cmd(ViewportCommand::InnerSize(size));
    }

    /// The result of the window.
    pub fn end(self) -> Result<()> {
        if let (Some(path), Some(kept)) = (&self.options.times, &self.times.kept) {
            saved::write_times(path, kept)?;
        }
        self.ended.and(self.painter.device().check())
    }

    /// Shows the panel. Returns the points at the left that it covers.
    fn controls(&mut self, ui: &mut Ui, note: &str) -> f32 {
        if !self.panel {
            return 0.0;
        }
        let told = Told {
            times: &self.times,
            problem: self.problem.as_deref(),
            note,
            undos: self.undo.len(),
            draw_paths: &self.painter.draw_paths,
        };
        let (shown, asked) = (&mut self.shown, &mut self.asked);
        let panel = Panel::left("panel").default_size(PANEL).show(ui, |ui| {
            let all = ScrollArea::vertical().auto_shrink(false);
            all.show(ui, |ui| controls::show(ui, shown, &told, asked));
        });
        panel.response.rect.right()
    }

    /// Turns the camera by the pointer over the free part, and loads files that were dropped.
    fn pointer(&mut self, ui: &Ui, free: Rect) {
        let (context, solid) = (ui.ctx(), ui.interact(free, Id::new("solid"), Sense::drag()));
        let pixels = context.pixels_per_point();
        let by = solid.drag_delta() * pixels;
        if solid.dragged() && by != Vec2::ZERO {
            let turns = solid.dragged_by(PointerButton::Primary);
            self.drag([by.x.into(), by.y.into()], turns);
        }
        let (wheel, dropped) = context.input(|input| {
            let steps = |event: &Event| match event {
                Event::MouseWheel { unit, delta, .. } if solid.contains_pointer() => match unit {
                    MouseWheelUnit::Point => Some(delta.y * pixels / 50.0),
                    _ => Some(delta.y),
                },
                _ => None,
            };
            let wheel: Vec<_> = input.events.iter().filter_map(steps).collect();
            (wheel, input.raw.dropped_files.clone())
        });
        wheel.into_iter().for_each(|steps| self.zoom(steps.into()));
        for file in dropped {
            self.load(file.path());
            context.send_viewport_cmd(ViewportCommand::Title(title(&self.source)));
        }
        if !context.input(|input| input.pointer.any_down()) && self.changing == Some(Change::Held) {
            self.changing = None;
        }
    }

    /// Shows scale and words over the free part.
    fn overlay(&self, context: &Context, free: Rect, note: &str) {
        if let Some(legend) = self.painter.texture().and(self.painter.legend.as_ref()) {
            overlay::legend(context, free, legend);
        }
        let hidden = |text| if self.panel { "" } else { text };
        let problem = hidden(self.problem.as_deref().unwrap_or_default());
        let hint = if self.hint { HINT } else { "" };
        let lines = [problem, hidden(note), &self.written, hint];
        overlay::lines(context, free, &lines);
        if self.help {
            overlay::help(context, free);
        }
    }

    /// Draws the picture if the shown state has changed, and writes it where that was requested.
    fn draw(&mut self, context: &Context, painting_ms: f64) {
        if self.options.frames.is_some() && self.shown.inspected == Inspected::Color {
            self.version += 1; // counted frames are drawn, even if nothing moves
        }
        let drawn = self
            .painter
            .update(&self.shown, self.version, &self.framing, context);
        match drawn {
            Ok(Some(mut cost)) => {
                cost.present += painting_ms;
                self.times.push(cost);
            }
            Ok(None) => {}
            Err(error) => self.problem = Some(error.to_string()),
        }
        if self.keep
            && let Some(picture) = self.painter.picture()
        {
            self.keep = false;
            let path = saved::beside(&self.source, ".png");
            let written = picture.write_png(&path);
            self.say(written.map(|()| path));
            context.request_repaint();
        }
    }

    /// Counts the frame, and ends after the last one that the options want.
    fn count(&mut self, context: &Context) {
        self.drawn += 1;
        let Some(frames) = self.options.frames else {
            return;
        };
        context.request_repaint();
        let Some(file) = &self.options.screenshot else {
            self.quit |= self.drawn >= frames;
            return;
        };
        if self.drawn == frames {
            context.send_viewport_cmd(ViewportCommand::Screenshot(Default::default()));
        }
        let image = context.input(|input| {
            let image = |event: &Event| match event {
                Event::Screenshot { image, .. } => Some(image.clone()),
                _ => None,
            };
            input.events.iter().find_map(image)
        });
        if let Some(image) = image {
            let [width, height] = image.size.map(|n| n as u32);
            let rgba = image.pixels.iter().map(Color32::to_array).collect();
            let picture = Picture {
                width,
                height,
                rgba,
            };
            self.ended = picture.write_png(file);
            if self.ended.is_ok() {
                output::result(&format!("{}: frame {frames}", file.display()));
            }
            self.quit = true;
        }
    }

    /// Draws by the folder's search as it is now; the former one stays if the new one has a fault.
    fn reload_search(&mut self) {
        let Some(changed) = self.search.as_ref().and_then(|s| s.try_recv().ok()) else {
            return;
        };
        match changed {
            Ok(new) => {
                let spec = |solver| folder::of(solver).map(|folder| &folder.spec);
                let states = self.undo.iter_mut();
                for state in states.chain([&mut self.first, &mut self.shown, &mut self.before]) {
                    if spec(state.search.solver) == spec(new) {
                        state.search.solver = new;
                    }
                }
                output::note(&format!("{new} was read again: the window draws by it"));
                self.version += 1;
                self.problem = None;
            }
            Err(error) => {
                output::warn(&error.to_string());
                self.problem = Some(error.to_string());
            }
        }
    }
}

/// The title of a window that shows this file.
pub fn title(source: &Path) -> String {
    format!("revmap: {}", source.display())
}

impl eframe::App for &mut App {
    fn raw_input_hook(&mut self, context: &Context, input: &mut RawInput) {
        if !context.text_edit_focused() && !Popup::is_any_open(context) {
            for action in keys::take(&mut input.events) {
                self.press(action);
            }
        }
        (self.before, self.asked) = (self.shown.clone(), Asked::default());
    }

    fn ui(&mut self, ui: &mut Ui, frame: &mut eframe::Frame) {
        let context = ui.ctx().clone();
        let whole = context.content_rect();
        let background = ui.painter().add(Shape::Noop);
        self.reload_search();
        let words = self.painter.words.clone();
        let covered = self.controls(ui, &words);
        if context.will_discard() {
            return; // the same frame comes again, laid out better
        }
        let free = whole.with_min_x(covered);
        self.pointer(ui, free);
        let (asked, before) = (self.asked, self.before.clone());
        if asked != Asked::default() {
            context.request_repaint();
        }
        self.take(asked, before);
        let pixels = context.pixels_per_point();
        let size = (whole.size() * pixels).round();
        let size = (size.x as u32, size.y as u32);
        let framing = Framing::new(size, (covered * pixels).round() as u32);
        if framing != self.framing {
            (self.framing, self.version) = (framing, self.version + 1);
        }
        // The frame before was painted after its picture was drawn.
        let cpu_ms = f64::from(frame.info().cpu_usage.unwrap_or_default()) * 1e3;
        let start = Instant::now();
        self.draw(&context, (cpu_ms - self.drawing_ms).max(0.0));
        self.drawing_ms = start.elapsed().as_secs_f64() * 1e3;
        if let Some(id) = self.painter.texture() {
            let all = Rect::from_min_max(pos2(0.0, 0.0), pos2(1.0, 1.0));
            let place = whole.with_min_x(self.framing.left as f32 / pixels);
            let picture = Shape::image(id, place, all, Color32::WHITE);
            ui.painter().set(background, picture);
        }
        self.overlay(&context, free, &words);
        self.count(&context);
        if self.quit {
            context.send_viewport_cmd(ViewportCommand::Close);
        }
    }
}
