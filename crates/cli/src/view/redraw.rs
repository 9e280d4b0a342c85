//! One frame of the window: keys, controls, the picture, files that were requested.

use super::actions::Change;
use super::app::{App, Open};
use super::controls::{self, Asked, Told};
use super::framing::Framing;
use super::inspect::Inspector;
use super::stage::Frame;
use super::{keys, overlay, saved};
use crate::output;
use egui::{Color32, Context, FullOutput, Panel, RawInput, Rect, TextureId, pos2};
use revmap::error::Result;
use std::time::Duration;

/// Width of the panel at the start, points.
const PANEL: f32 = 316.0;
/// Shown until the help has been shown.
const HINT: &str = "H: help";

/// What the controls leave to be drawn and done.
struct Pass {
    output: FullOutput,
    asked: Asked,
    framing: Framing,
}

impl App {
    /// Draws a frame. Returns the delay until the next frame if no event comes.
    pub(super) fn frame(&mut self) -> Result<Option<Duration>> {
        let Some(open) = &mut self.open else {
            return Ok(None);
        };
        let size = open.window.inner_size();
        let size = (size.width, size.height);
        if size.0 == 0 || size.1 == 0 {
            return Ok(None); // minimised
        }
        let shaders = open.reload_shaders(&self.shown)?;
        let mut input = open.gui.take_egui_input(&open.window);
        let context = open.gui.egui_ctx().clone();
        if !context.text_edit_focused() && !egui::Popup::is_any_open(&context) {
            for action in keys::take(&mut input.events) {
                self.press(action);
            }
        }
        let picture = self.inspected(size, &context);
        // A picture that is not there yet is awaited.
        let ready = picture.is_some() || !Inspector::is_wanted(&self.shown);
        let mut keep = self.keep && ready;
        let before = self.shown.clone();
        let Some(pass) = self.controls(input, &context, picture, (size, keep), shaders) else {
            return Ok(None);
        };
        let framed = pass.framing != self.framing;
        if framed {
            keep = false; // the picture has the former framing
            (self.framing, self.version) = (pass.framing, self.version + 1);
        }
        self.take(pass.asked, before);
        if self.changing == Some(Change::Held) && !context.input(|i| i.pointer.any_down()) {
            self.changing = None;
        }
        let pause = self.draw(pass.output, &context, (size, keep))?;
        Ok(pause.map(|pause| if framed { Duration::ZERO } else { pause }))
    }

    /// The picture that is shown in place of the drawn scene.
    fn inspected(&mut self, size: (u32, u32), context: &Context) -> Option<TextureId> {
        // The framing is known after the first frame of a size.
        if !Inspector::is_wanted(&self.shown) || self.framing.window != size {
            return None;
        }
        let Open {
            inspector, stage, ..
        } = self.open.as_mut()?;
        let (version, framing) = (self.version, &self.framing);
        let (device, wake) = (&stage.device, &self.wake);
        match inspector.picture(&self.shown, version, framing, device, context, wake) {
            Ok(texture) => texture.map(egui::TextureHandle::id),
            Err(error) => {
                self.problem = Some(error.to_string());
                None
            }
        }
    }

    /// Runs the controls: the panel, and words over the free part unless that is kept as a file.
    fn controls(
        &mut self,
        input: RawInput,
        context: &Context,
        picture: Option<TextureId>,
        (size, keep): ((u32, u32), bool),
        shaders: &str,
    ) -> Option<Pass> {
        let open = self.open.as_ref()?;
        let inspects = Inspector::is_wanted(&self.shown);
        let draw_paths = match inspects {
            true => open.inspector.draw_paths.clone(),
            false => open.stage.draw_paths(),
        };
        let told = Told {
            times: &self.times,
            problem: self.problem.as_deref(),
            notes: [if inspects { &open.inspector.words } else { "" }, shaders],
            undos: self.undo.len(),
            draw_paths: &draw_paths,
        };
        let (shown, panel) = (&mut self.shown, self.panel);
        let (mut asked, mut covered) = (Asked::default(), 0.0);
        let output = context.run_ui(input, |ui| {
            if let Some(id) = picture {
                let all = Rect::from_min_max(pos2(0.0, 0.0), pos2(1.0, 1.0));
                let area = ui.ctx().content_rect();
                ui.painter().image(id, area, all, Color32::WHITE);
            }
            if panel {
                let panel = Panel::left("panel").default_size(PANEL);
                let shown = panel.show(ui, |ui| {
                    let all = egui::ScrollArea::vertical().auto_shrink(false);
                    all.show(ui, |ui| asked = controls::show(ui, shown, &told));
                });
                covered = shown.response.rect.right();
            }
            if keep {
                return;
            }
            let mut free = ui.ctx().content_rect();
            free.min.x = covered;
            if let Some(legend) = picture.and(open.inspector.legend.as_ref()) {
                overlay::legend(ui.ctx(), free, legend);
            }
            let hidden = |text| if panel { "" } else { text };
            let [numbers, shaders] = told.notes.map(hidden);
            let problem = hidden(told.problem.unwrap_or_default());
            let hint = if self.hint { HINT } else { "" };
            let lines = [problem, numbers, shaders, &self.written, hint];
            overlay::lines(ui.ctx(), free, &lines);
            if self.help {
                overlay::help(ui.ctx(), free);
            }
            #[cfg(feature = "shaderc")]
            if let Some(text) = open.reload.as_ref().and_then(|r| r.problem.as_deref()) {
                controls::shader_problem(ui.ctx(), text);
            }
        });
        let covered = (covered * output.pixels_per_point).round() as u32;
        Some(Pass {
            output,
            asked,
            framing: Framing::new(size, covered),
        })
    }

    /// Draws and presents the scene or its picture, and the controls.
    fn draw(
        &mut self,
        mut output: FullOutput,
        context: &Context,
        (size, keep): ((u32, u32), bool),
    ) -> Result<Option<Duration>> {
        let last = self.is_last() && self.options.screenshot.is_some();
        let inspects = Inspector::is_wanted(&self.shown);
        let Some(open) = &mut self.open else {
            return Ok(None);
        };
        if let Err(error) = open.stage.set(&self.shown) {
            self.problem = Some(error.to_string());
        }
        let platform = std::mem::take(&mut output.platform_output);
        open.gui.handle_platform_output(&open.window, platform);
        let root = output.viewport_output.get(&egui::ViewportId::ROOT);
        let pause = root.map_or(Duration::MAX, |v| v.repaint_delay);
        let scene = &self.shown.scene;
        let camera = self.framing.camera(&scene.camera, 1);
        let scene = (!inspects).then_some((&camera, scene.background));
        let problem = &mut self.problem;
        let drawn = open
            .stage
            .draw(scene, output, context, keep || last, problem)?;
        let stale = drawn.as_ref().is_none_or(|frame| frame.stale);
        if stale {
            open.stage.resize(size)?;
            open.window.request_redraw();
        }
        if let Some(mut frame) = drawn {
            if let Some(ms) = open.inspector.device_ms.filter(|_| inspects) {
                frame.cost.device = ms;
            }
            self.keep_frame(frame, keep)?;
        }
        Ok(Some(pause))
    }

    /// Returns true if the frame is the last one that the options want.
    fn is_last(&self) -> bool {
        self.options.frames == Some(self.drawn + 1)
    }

    /// Keeps a frame's cost, and writes its picture where that was requested: `keep` for the free
    /// part in a new file.
    fn keep_frame(&mut self, frame: Frame, keep: bool) -> Result<()> {
        let last = self.is_last();
        self.times.push(frame.cost);
        self.drawn += 1;
        let Some(picture) = frame.picture else {
            return Ok(());
        };
        if let (true, Some(file)) = (last, &self.options.screenshot) {
            picture.write_png(file)?;
            output::result(&format!("{}: frame {}", file.display(), self.drawn));
        }
        if keep {
            self.keep = false;
            let path = saved::beside(&self.source, ".png");
            let written = self.framing.crop(&picture).write_png(&path);
            self.say(written.map(|()| path));
            self.redraw();
        }
        Ok(())
    }

    /// Requests another frame.
    fn redraw(&self) {
        if let Some(open) = &self.open {
            open.window.request_redraw();
        }
    }
}

impl Open {
    /// Draws with changed shaders when they compile. Returns the state of their compilation.
    #[cfg(feature = "shaderc")]
    fn reload_shaders(&mut self, shown: &super::shown::Shown) -> Result<&'static str> {
        let Some(reload) = &mut self.reload else {
            return Ok("");
        };
        let (host, format) = (&self.stage.host, self.stage.format());
        if let Some(made) = reload.take(host, format, shown) {
            self.inspector.forget();
            self.stage.take(made)?;
        }
        let busy = reload.is_busy();
        Ok(if busy {
            "the shaders are being compiled"
        } else {
            ""
        })
    }

    #[cfg(not(feature = "shaderc"))]
    fn reload_shaders(&mut self, _: &super::shown::Shown) -> Result<&'static str> {
        Ok("")
    }
}
