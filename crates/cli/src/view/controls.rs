//! Sliders and choices for all values of a scene and its search.

use super::shown::{Inspected, Shown};
use super::times::Times;
use eframe::egui::{self, CollapsingHeader, ComboBox, DragValue, Slider, Ui};
use revmap::gpu::DrawPath;
use revmap::maps::Projection;
use revmap::scene::{BumpForm, Clip, Environment, Light, Object, Scene, Shadow};
use revmap::settings::{DrawStage, SearchSettings, Tolerance};
use revmap_searches::folder;

/// Information that the controls show besides values.
pub struct Told<'a> {
    pub times: &'a Times,
    /// The problem that the last values caused.
    pub problem: Option<&'a str>,
    /// The numbers of an inspected picture.
    pub note: &'a str,
    pub undos: usize,
    /// The draw path of each object.
    pub draw_paths: &'a [DrawPath],
}

/// The requests of the user.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Asked {
    /// A value was changed.
    pub changed: bool,
    pub undo: bool,
    pub reset: bool,
    /// Save the scene as TOML.
    pub save: bool,
    /// Save the part of the window beside the panel as a picture.
    pub screenshot: bool,
    pub turntable: bool,
}

/// Shows all controls, and adds their requests to `asked`: a frame may be laid out twice.
pub fn show(ui: &mut Ui, shown: &mut Shown, told: &Told, asked: &mut Asked) {
    ui.horizontal(|ui| {
        let undo = egui::Button::new("Undo");
        asked.undo |= ui.add_enabled(told.undos > 0, undo).clicked();
        asked.reset |= ui.button("Reset").clicked();
        asked.save |= ui.button("Save").clicked();
        asked.screenshot |= ui.button("Screenshot").clicked();
        asked.turntable |= ui.button("Turntable").clicked();
    });
    if let Some(text) = told.problem {
        ui.colored_label(egui::Color32::LIGHT_RED, text);
    }
    told.times.show(ui);
    if !told.note.is_empty() {
        ui.label(told.note);
    }
    ui.horizontal(|ui| {
        asked.changed |= choice(ui, "stage", &mut shown.stage, &DrawStage::NAMES);
        asked.changed |= choice(ui, "show", &mut shown.inspected, &Inspected::NAMES);
    });
    let Shown {
        scene,
        search,
        studio,
        ..
    } = shown;
    for (n, one) in scene.objects.iter_mut().enumerate() {
        let path = told.draw_paths.get(n);
        let path = path.map_or(String::new(), |p| format!(" ({p:?})"));
        let title = format!("{n}: {}{path}", one.name);
        CollapsingHeader::new(title)
            .id_salt(("object", n))
            .default_open(n == 0)
            .show(ui, |ui| asked.changed |= object(ui, one));
    }
    if studio.is_none() {
        CollapsingHeader::new("Lights").show(ui, |ui| asked.changed |= lights(ui, scene));
    }
    CollapsingHeader::new("Search").show(ui, |ui| asked.changed |= how(ui, search));
    CollapsingHeader::new("Camera").show(ui, |ui| {
        let angle = Slider::new(&mut scene.camera.fov_y, 5.0..=120.0).text("fov_y");
        asked.changed |= ui.add(angle).changed();
    });
}

fn object(ui: &mut Ui, object: &mut Object) -> bool {
    let mut changed = false;
    let mut slide = |ui: &mut Ui, value: &mut f64, range, name: &str| {
        changed |= ui.add(Slider::new(value, range).text(name)).changed();
    };
    slide(ui, &mut object.offset.extend, -0.2..=0.2, "extend e");
    slide(ui, &mut object.offset.bevel, 0.0..=2.0, "bevel b");
    slide(ui, &mut object.offset.chamfer, 0.0..=1.0, "chamfer c");
    slide(ui, &mut object.texturing.bump, 0.0..=3.0, "bump a");
    let scale = object.placement.scale.as_mut();
    for (value, name) in scale.iter_mut().zip(["scale x", "scale y", "scale z"]) {
        slide(ui, value, 0.1..=4.0, name);
    }
    for (value, name) in object.axis.iter_mut().zip(["axis x", "axis y"]) {
        slide(ui, value, 0.0..=1.0, name);
    }
    changed |= row(ui, "repeat", |ui| {
        let count = |n| DragValue::new(n).range(1..=16).speed(0.05);
        any(object.repeat.iter_mut().map(|n| ui.add(count(n)).changed()))
    });
    changed |= row(ui, "mirror", |ui| {
        let flags = object.mirror.iter_mut().zip(["x", "y", "z"]);
        any(flags.map(|(flag, name)| ui.checkbox(flag, name).changed()))
    });
    let place = object.placement.position.as_mut();
    changed |= row(ui, "position", |ui| coordinates(ui, place));
    changed |= row(ui, "colour", |ui| {
        ui.color_edit_button_rgb(&mut object.color).changed()
    });
    let (specular, texturing) = (&mut object.specular, &mut object.texturing);
    let strength = Slider::new(&mut specular.strength, 0.0..=1.0);
    changed |= ui.add(strength.text("specular")).changed();
    let shininess = Slider::new(&mut specular.shininess, 1.0..=256.0).logarithmic(true);
    changed |= ui.add(shininess.text("shininess")).changed();
    changed |= choice(ui, "clip", &mut object.clip, &Clip::NAMES);
    changed |= choice(
        ui,
        "projection",
        &mut texturing.projection,
        &Projection::NAMES,
    );
    changed | choice(ui, "bump form", &mut texturing.bump_form, &BumpForm::NAMES)
}

fn lights(ui: &mut Ui, scene: &mut Scene) -> bool {
    let mut changed = choice(ui, "shadow", &mut scene.shadow, &Shadow::NAMES);
    changed |= row(ui, "ambient", |ui| {
        ui.color_edit_button_rgb(&mut scene.ambient).changed()
    });
    if let Some(Environment { up, down }) = &mut scene.environment {
        changed |= row(ui, "environment", |ui| {
            any([up, down]
                .into_iter()
                .map(|side| ui.color_edit_button_rgb(side).changed()))
        });
    }
    for (n, light) in scene.lights.iter_mut().enumerate() {
        changed |= row(ui, &format!("light {n}"), |ui| {
            let turned = coordinates(ui, light.direction.as_mut());
            let colored = ui.color_edit_button_rgb(&mut light.color).changed();
            let radius = DragValue::new(&mut light.radius)
                .range(0.0..=Light::LARGEST_RADIUS)
                .speed(0.05)
                .suffix("°");
            let sized = scene.shadow == Shadow::Soft && ui.add(radius).changed();
            turned | colored | sized
        });
    }
    changed
        | row(ui, "lights", |ui| {
            let more = ui.button("add").clicked();
            let fewer = ui.button("remove").clicked();
            if more {
                scene.lights.push(Light::default());
            } else if fewer {
                scene.lights.pop();
            }
            more | fewer
        })
}

fn how(ui: &mut Ui, search: &mut SearchSettings) -> bool {
    let solvers = revmap_searches::ALL.into_iter().chain(folder::latest());
    let solvers: Vec<_> = solvers.map(|s| (s.name(), s)).collect();
    let mut changed = choice(ui, "solver", &mut search.solver, &solvers);
    let [a, b, c] = revmap_files::MAP_SOURCES.map(|(name, source)| (name, Some(source)));
    let sources = [("best", None), a, b, c];
    changed |= choice(ui, "map source", &mut search.map_source, &sources);
    let mut pixels = search.tolerance.pixels();
    let slider = Slider::new(&mut pixels, 0.0..=8.0).logarithmic(true);
    changed |= ui.add(slider.text("tolerance, pixels")).changed();
    // The slider's range is within the tolerance's range.
    search.tolerance = Tolerance::new(pixels).unwrap_or(search.tolerance);
    changed |= optional(ui, "map rows", &mut search.map_rows, 512, 2..=4096);
    changed | optional(ui, "max steps", &mut search.max_steps, 64, 1..=1024)
}

fn coordinates(ui: &mut Ui, values: &mut [f64; 3]) -> bool {
    let value = |v| DragValue::new(v).speed(0.01);
    any(values.iter_mut().map(|v| ui.add(value(v)).changed()))
}

/// A number that may be left to the program.
fn optional(
    ui: &mut Ui,
    name: &str,
    value: &mut Option<u32>,
    first: u32,
    range: std::ops::RangeInclusive<u32>,
) -> bool {
    row(ui, name, |ui| {
        let mut given = value.is_some();
        let switched = ui.checkbox(&mut given, "").changed();
        if switched {
            *value = given.then_some(first);
        }
        let slider = |n| Slider::new(n, range).logarithmic(true);
        let moved = value.as_mut().is_some_and(|n| ui.add(slider(n)).changed());
        switched | moved
    })
}

fn choice<T: Copy + PartialEq>(ui: &mut Ui, name: &str, value: &mut T, all: &[(&str, T)]) -> bool {
    let before = *value;
    let known = all.iter().find(|(_, v)| *v == before);
    let known = known.map_or("", |(name, _)| name);
    ComboBox::from_label(name)
        .selected_text(known)
        .show_ui(ui, |ui| {
            for (name, one) in all {
                ui.selectable_value(value, *one, *name);
            }
        });
    *value != before
}

fn row(ui: &mut Ui, name: &str, add: impl FnOnce(&mut Ui) -> bool) -> bool {
    ui.horizontal(|ui| {
        ui.label(name);
        add(ui)
    })
    .inner
}

/// Returns true if any value is true. All values are evaluated, since each is a control that must
/// be shown.
fn any(all: impl Iterator<Item = bool>) -> bool {
    all.fold(false, |a, b| a | b)
}
