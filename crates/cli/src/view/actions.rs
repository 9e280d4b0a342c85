//! Executes the requests of the controls and the pointer.

use super::app::App;
use super::controls::Asked;
use super::keys::Action;
use super::picture::colors;
use super::shown::{Change, Shown};
use super::{orbit, saved};
use crate::animate::turn_about_target;
use crate::output;
use glam::DVec3;
use revmap::error::{self, Error, Result};
use revmap::settings::{Planes, Settings};
use revmap_files::SceneFile;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// The number of changes that can be undone.
const UNDOS: usize = 100;

/// The number of frames of a turntable.
const TURNTABLE: u32 = 36;

impl App {
    /// Executes the effect of a key.
    pub fn press(&mut self, action: Action) {
        let before = self.shown.clone();
        match action {
            Action::Help => (self.help, self.hint) = (!self.help, false),
            Action::Panel => self.panel = !self.panel,
            Action::Show(inspected) => self.shown.inspected = inspected,
            Action::Stage(stage) => self.shown.stage = stage,
            Action::ResetCamera => self.shown.scene.camera = self.first.scene.camera,
            Action::Screenshot => self.keep = true,
            Action::Undo => {}
            Action::Close if self.help => self.help = false,
            Action::Close => self.quit = true,
        }
        let changed = matches!(
            action,
            Action::Show(_) | Action::Stage(_) | Action::ResetCamera
        );
        if changed {
            self.changing = None;
        }
        let asked = Asked {
            changed,
            undo: action == Action::Undo,
            ..Asked::default()
        };
        self.take(asked, before);
    }

    /// Executes the requests of the controls.
    pub fn take(&mut self, asked: Asked, before: Shown) {
        if asked != Asked::default() {
            self.problem = None;
        }
        if asked.changed || asked.undo || asked.reset {
            self.change();
        }
        if asked.undo {
            self.changing = None;
            if let Some(shown) = self.undo.pop() {
                self.shown = shown;
            }
        } else if asked.reset {
            self.changing = None;
            self.remember(Change::Held, before);
            self.shown = self.first.clone();
        } else if asked.changed {
            self.remember(Change::Held, before);
        }
        self.keep |= asked.screenshot;
        if asked.save {
            let mut first = self.first.scene.clone();
            if self.first.studio.is_some() {
                // The camera that a studio has chosen is in no file.
                (first.camera.eye, first.camera.target) = (DVec3::NAN, DVec3::NAN);
                first.camera.fov_y = f64::NAN;
            }
            let shown = &self.shown.scene;
            let written = saved::write_scene(&self.source, &self.file, &first, shown);
            self.say(written);
        }
        if asked.turntable {
            let written = self.write_turntable();
            self.say(written);
        }
    }

    /// Counts a change of the shown state, after which the last report is old.
    fn change(&mut self) {
        self.version += 1;
        self.written.clear();
    }

    /// Reports the written file, or the failure.
    pub fn say(&mut self, written: Result<PathBuf>) {
        match written {
            Ok(path) => {
                self.written = format!("written: {}", path.display());
                output::result(&self.written);
            }
            Err(error) => self.problem = Some(error.to_string()),
        }
    }

    /// Draws a whole turn about the target into a new folder of numbered pictures: all of them, or
    /// no folder.
    fn write_turntable(&mut self) -> Result<PathBuf> {
        let folder = saved::beside(&self.source, "-turntable");
        std::fs::create_dir(&folder).map_err(|e| {
            let message = format!("cannot be made ({e}); move the scene to another folder");
            Error::new(error::ErrorKind::File, message).in_file(&folder)
        })?;
        match self.write_turned(&folder) {
            Ok(()) => Ok(folder),
            Err(error) => {
                // The first failure is more useful than one from removing its remains.
                let _ = std::fs::remove_dir_all(&folder);
                Err(error)
            }
        }
    }

    fn write_turned(&mut self, folder: &Path) -> Result<()> {
        let settings = Settings {
            planes: Planes::Color,
            ..self.shown.settings(self.framing.window)
        };
        for n in 0..TURNTABLE {
            let mut turned = self.shown.clone();
            let angle = std::f64::consts::TAU * f64::from(n) / f64::from(TURNTABLE);
            turn_about_target(&mut turned.scene.camera, angle);
            let (drawn, _) = self.painter.draw(&turned.furnished(), settings)?;
            let file = folder.join(format!("frame-{n:04}.png"));
            colors(drawn, &settings)?.write_png(file)?;
        }
        Ok(())
    }

    /// Shows a file that was dropped on the window.
    pub fn load(&mut self, path: &Path) {
        let read = SceneFile::open(path).and_then(|mut file| {
            let (options, aspect) = (&self.options.surroundings, self.framing.aspect());
            let (scene, studio) = options.read(&mut file, &[], aspect)?;
            Ok((scene, studio.map(Arc::new), file))
        });
        match read {
            Ok((scene, studio, file)) => {
                // The undo list belongs to the former file.
                (self.undo, self.changing) = (Vec::new(), None);
                (self.shown.scene, self.shown.studio) = (scene, studio);
                self.first = self.shown.clone();
                (self.source, self.file) = (path.to_owned(), file);
                self.problem = None;
                self.change();
            }
            Err(error) => self.problem = Some(error.to_string()),
        }
    }

    /// Turns the camera by a drag in pixels, or shifts it.
    pub fn drag(&mut self, by: [f64; 2], turns: bool) {
        self.remember(Change::Held, self.shown.clone());
        self.change();
        let height = self.framing.height();
        let camera = &mut self.shown.scene.camera;
        match turns {
            true => orbit::turn(camera, by),
            false => orbit::shift(camera, by, height),
        }
    }

    /// Handles a turn of the wheel by `steps`.
    pub fn zoom(&mut self, steps: f64) {
        self.remember(Change::Wheel, self.shown.clone());
        self.change();
        orbit::zoom(&mut self.shown.scene.camera, steps);
    }

    /// Stores the state before a change for undoing, unless the change continues an earlier one.
    fn remember(&mut self, change: Change, before: Shown) {
        if self.changing == Some(change) {
            return;
        }
        self.changing = Some(change);
        self.undo.push(before);
        if self.undo.len() > UNDOS {
            self.undo.remove(0);
        }
    }
}
