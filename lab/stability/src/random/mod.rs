//! Random scenes, held to the reference, and reduced to the smallest that still fail.

mod along_axis;
mod numbers;
mod reduced;

use super::case::Step;
use super::judge::Truth;
use super::run::both_stages;
use numbers::Random;
use revmap::error::Result;
use revmap::gpu::Device;
use revmap::settings::Solver;
use revmap_figures::files::write_text;
use std::f64::consts::TAU;
use std::fmt::Write;
use std::path::Path;

/// Pixels of a random scene.
const SIZE: (u32, u32) = (96, 72);

/// From this seed on, some scenes are close views of outlines with short edges. The scenes of
/// earlier seeds stay as results and tests have them.
const CLOSE_UPS_FROM: u64 = 300_000;

/// From this seed on, scenes are views along the axis.
pub const ALONG_AXIS_FROM: u64 = 50_000_000;

/// A scene in the making: parts that can be left out one by one.
#[derive(Clone, Debug, PartialEq)]
pub struct Draft {
    seed: u64,
    /// Pixels.
    size: (u32, u32),
    camera: String,
    /// Lines of the scene and lights.
    lines: Vec<String>,
    lights: Vec<[f64; 3]>,
    objects: Vec<DraftObject>,
}

#[derive(Clone, Debug, PartialEq)]
struct DraftObject {
    polygon: Vec<[f64; 2]>,
    keys: Vec<String>,
    /// Rows of its file of instances.
    copies: Vec<[f64; 10]>,
}

struct DraftCamera {
    eye: [f64; 3],
    target: [f64; 3],
    fov: f64,
}

impl DraftCamera {
    fn text(&self, up: [f64; 3]) -> String {
        let Self { eye, target, fov } = self;
        format!("[camera]\neye = {eye:?}\ntarget = {target:?}\nfov_y = {fov:?}\nup = {up:?}")
    }
}

/// A direction that few views are along.
const OBLIQUE: [f64; 3] = [0.3, 0.2, 1.0];

/// A random scene that failed.
#[derive(Clone, Debug)]
pub struct Failure {
    /// The seed that gave it.
    pub seed: u64,
    /// What failed, in the smallest scene.
    pub what: String,
    /// The file that holds the smallest scene.
    pub file: String,
}

impl Random {
    fn any_polygon(&mut self) -> Vec<[f64; 2]> {
        let count = 3 + self.below(9);
        let kind = self.below(4) as u64;
        self.polygon(kind, count)
    }

    /// Makes the first object or the view extreme in one way.
    fn extreme(&mut self, objects: &mut [DraftObject], scale: f64, camera: &mut DraftCamera) {
        let object = &mut objects[0];
        let polygon = &mut object.polygon;
        let away = |camera: &mut DraftCamera, by: f64| {
            for (eye, target) in camera.eye.iter_mut().zip(camera.target) {
                *eye = target + by * (*eye - target);
            }
        };
        match (9.0 * self.next()) as u32 {
            // Very long along one or two axes.
            0 => {
                let by = self.log(1e2, 1e5);
                let long = [(); 3].map(|()| scale * self.maybe(2.0, 1.0, |_| by));
                object.keys.retain(|key| !key.starts_with("scale"));
                object.keys.push(format!("scale = {long:?}"));
                away(camera, by);
            }
            // Small in its box, as lengths in the wrong unit.
            1 => {
                let by = self.log(1e-5, 0.1);
                polygon.iter_mut().for_each(|p| *p = p.map(|v| by * v));
                camera.target[2] -= 0.5 * scale;
                camera.eye[2] -= 0.5 * scale;
                away(camera, by);
            }
            // Much wider than high.
            2 => {
                let by = self.log(10.0, 1e3);
                polygon.iter_mut().for_each(|p| p[0] *= by);
                away(camera, by);
            }
            // Nearly level: lids, thin rings.
            3 => {
                let by = self.log(1e-4, 0.1);
                let level = self.between(0.1, 0.9);
                let squeezed = |z: f64| level + by * (z - 0.5);
                polygon.iter_mut().for_each(|p| p[1] = squeezed(p[1]));
            }
            // A section without thickness: out and back along a line.
            4 => {
                let n = self.below(polygon.len());
                let (root, tip) = (polygon[n], [self.between(0.0, 0.5), self.between(0.0, 1.0)]);
                polygon.splice(n..n, [root, tip]);
            }
            // A corner twice, or nearly.
            5 => {
                let n = self.below(polygon.len());
                let by = self.maybe(2.0, 0.0, |r| r.log(1e-12, 1e-4));
                let [r, z] = polygon[n];
                polygon.insert(n, [r + by, z]);
            }
            // Along the axis, from above or below.
            6 => {
                let up = if self.once_in(2.0) { 1.0 } else { -1.0 };
                let far = self.log(1.0, 1e3);
                let aside = self.maybe(2.0, 0.0, |r| r.log(1e-9, 1e-2));
                camera.eye = camera.target;
                camera.eye[0] += aside * scale;
                camera.eye[2] += up * far * scale;
                camera.fov = (2.0 * (0.8 / far).atan().to_degrees()).min(80.0);
            }
            // Along a level face.
            7 => {
                let n = self.below(polygon.len());
                camera.eye[2] = camera.target[2] + scale * (polygon[n][1] - 0.5);
                camera.target[2] = camera.eye[2];
            }
            // A very wide field of view.
            _ => camera.fov = self.between(90.0, 170.0),
        }
    }

    /// Cuts corners of an object's polygon off by short edges, and looks at one of them closely.
    fn close_up(
        &mut self,
        object: &mut DraftObject,
        scale: f64,
        at: [f64; 3],
        camera: &mut DraftCamera,
    ) {
        let polygon = &mut object.polygon;
        let mut corner = polygon[0];
        // Cuts of a section without thickness give one of rounding errors, of which no search knows.
        let is_twice = |k: usize| polygon[..k].contains(&polygon[k]);
        let is_thin = (0..polygon.len()).any(is_twice);
        for _ in 0..3 * u32::from(!is_thin) {
            let count = polygon.len();
            let n = self.below(count);
            let [before, here, after] = [n + count - 1, n, n + 1].map(|k| polygon[k % count]);
            let length = self.log(1e-4, 0.05);
            let towards = |other: [f64; 2]| {
                let way = [0, 1].map(|c| other[c] - here[c]);
                let far = way[0].hypot(way[1]).max(1e-9);
                [0, 1].map(|c| here[c] + way[c] * (length / far).min(0.4))
            };
            if here[0] > 0.0 {
                corner = towards(after);
                polygon.splice(n..=n, [towards(before), corner]);
            }
        }
        let placed = ["position", "color"];
        (object.keys).retain(|key| placed.iter().any(|name| key.starts_with(name)));
        object.keys.push(format!("scale = {:?}", [scale; 3]));
        object.copies.clear();
        let (s, c) = self.between(0.0, TAU).sin_cos();
        let local = [corner[0] * c, corner[0] * s, corner[1]];
        let (way, away) = (self.direction(), self.between(1.5, 4.0));
        camera.target = [0, 1, 2].map(|k| at[k] + scale * local[k]);
        camera.eye = [0, 1, 2].map(|k| camera.target[k] + scale * away * way[k]);
        camera.fov = self.between(1.0, 10.0);
    }

    fn object(&mut self, scale: f64, at: [f64; 3]) -> DraftObject {
        let mut keys = Vec::new();
        let mut copies = Vec::new();
        let sides = [(); 3].map(|()| scale * self.maybe(3.0, 1.0, |r| r.log(0.25, 4.0)));
        let turn = self.maybe(3.0, [0.0, 0.0, 0.0, 1.0], Self::rotation);
        keys.push(format!("position = {at:?}"));
        keys.push(format!("scale = {sides:?}"));
        keys.push(format!("rotation = {turn:?}"));
        keys.push(format!("color = {:?}", [(); 3].map(|()| self.next())));
        if self.once_in(3.0) {
            keys.push(format!("extend = {:?}", self.between(-0.05, 0.1)));
        }
        if self.once_in(3.0) {
            keys.push(format!("bevel = {:?}", self.log(0.05, 2.0)));
            keys.push(format!("chamfer = {:?}", self.between(0.05, 0.3)));
        }
        if self.once_in(6.0) {
            keys.push(format!("axis = {:?}", [self.next(), self.next()]));
        }
        if self.once_in(6.0) {
            let n = [(); 3].map(|()| 1 + (3.0 * self.next()) as u32);
            keys.push(format!("repeat = {n:?}"));
            let mirror = [(); 3].map(|()| self.once_in(2.0));
            keys.push(format!("mirror = {mirror:?}"));
        }
        if self.once_in(6.0) {
            for _ in 0..3 {
                let [x, y, z] = self.direction().map(|d| 0.6 * scale * d);
                let [a, b, c, d] = self.rotation();
                let s = scale * self.between(0.3, 1.0);
                copies.push([at[0] + x, at[1] + y, at[2] + z, a, b, c, d, s, s, s]);
            }
        }
        DraftObject {
            polygon: self.any_polygon(),
            keys,
            copies,
        }
    }
}

impl Draft {
    /// The scene of a seed.
    pub fn new(seed: u64) -> Self {
        if seed >= ALONG_AXIS_FROM {
            return Self::along_axis(seed);
        }
        let r = &mut numbers::of(seed);
        let scale = r.maybe(3.0, 1.0, |r| r.log(1e-4, 1e4));
        let middle = r.maybe(4.0, [0.0; 3], |r| {
            let far = r.log(1.0, 1e5);
            r.direction().map(|d| far * d)
        });
        let count = 1 + (2.0 * r.next() * r.next() * 2.0) as usize;
        let objects = (0..count)
            .map(|k| {
                let aside = r
                    .direction()
                    .map(|d| if k == 0 { 0.0 } else { 0.5 * scale * d });
                r.object(scale, [0, 1, 2].map(|c| middle[c] + aside[c]))
            })
            .collect();
        let away = if r.once_in(8.0) {
            r.between(0.05, 0.8)
        } else {
            r.log(1.2, 1e3)
        };
        let way = r.direction();
        let target = [0, 1, 2].map(|c| middle[c] + if c == 2 { 0.5 * scale } else { 0.0 });
        let eye = [0, 1, 2].map(|c| target[c] + away * scale * way[c]);
        let fov = (2.0 * (0.8 / away).atan().to_degrees()).min(80.0);
        let mut camera = DraftCamera { eye, target, fov };
        let lines = r.maybe(6.0, Vec::new(), |_| vec!["shadow = \"hard\"".to_owned()]);
        let lights = (0..1 + (2.0 * r.next()) as usize)
            .map(|_| r.direction())
            .collect();
        let mut objects: Vec<DraftObject> = objects;
        if r.once_in(2.0) {
            r.extreme(&mut objects, scale, &mut camera);
        }
        if seed >= CLOSE_UPS_FROM && r.once_in(4.0) {
            r.close_up(&mut objects[0], scale, middle, &mut camera);
        }
        Self {
            seed,
            size: SIZE,
            camera: camera.text(OBLIQUE),
            lines,
            lights,
            objects,
        }
    }

    fn file(&self, object: usize) -> String {
        format!("random-{}-{object}.csv", self.seed)
    }

    /// The scene as TOML.
    pub fn text(&self) -> String {
        let mut out = String::new();
        for line in &self.lines {
            let _ = writeln!(out, "{line}");
        }
        let _ = writeln!(out, "{}", self.camera);
        for light in &self.lights {
            let _ = writeln!(out, "[[light]]\ndirection = {light:?}");
        }
        for (k, object) in self.objects.iter().enumerate() {
            let _ = writeln!(out, "[[object]]\npolygon = {:?}", object.polygon);
            for key in &object.keys {
                let _ = writeln!(out, "{key}");
            }
            if !object.copies.is_empty() {
                let _ = writeln!(out, "instances = {:?}", self.file(k));
            }
        }
        out
    }

    /// The files that the text names, and what they hold.
    fn instance_files(&self) -> impl Iterator<Item = (String, String)> {
        let objects = self.objects.iter().enumerate();
        let row = |row: &[f64; 10]| row.map(|v| format!("{v:?}")).join(",") + "\n";
        let with_copies = objects.filter(|(_, object)| !object.copies.is_empty());
        with_copies.map(move |(k, object)| (self.file(k), object.copies.iter().map(row).collect()))
    }

    /// What the default fails in this scene; `None` where it passes, or the scene is refused.
    pub fn fails(&self, device: &Device, folder: &Path) -> Result<Option<String>> {
        for (name, rows) in self.instance_files() {
            write_text(&folder.join(name), &rows)?;
        }
        let step = Step::new(self.text()).sized(self.size.0, self.size.1);
        // A part less may be a scene that is refused, as a polygon of two points.
        let Ok(scene) = step.read(folder) else {
            return Ok(None);
        };
        let Ok(truth) = Truth::new(&scene, &step) else {
            return Ok(None);
        };
        for one in both_stages(device, &step, &scene, &truth, Solver::DEFAULT)? {
            let what = match one.result {
                Ok((.., judged)) if judged.passes(truth.limit) => continue,
                Ok((.., judged)) => judged.to_string(),
                Err(error) => {
                    device.check()?;
                    error.to_string()
                }
            };
            return Ok(Some(format!("{:?}: {what}", one.stage)));
        }
        Ok(None)
    }
}

/// Draws the scenes of `count` seeds from `seed` on. Each that fails is written into `folder` as
/// `random-SEED-whole.toml`, and reduced as `random-SEED.toml`. `progress` is told how many are
/// done, and ends it by `false`.
pub fn run(
    device: &Device,
    (seed, count): (u64, u64),
    folder: &Path,
    progress: &mut dyn FnMut(u64) -> bool,
) -> Result<Vec<Failure>> {
    let mut failures = Vec::new();
    for done in 0..count {
        if !progress(done) {
            break;
        }
        let draft = Draft::new(seed.wrapping_add(done));
        let Some(whole) = draft.fails(device, folder)? else {
            for file in draft.instance_files() {
                let _ = std::fs::remove_file(folder.join(file.0));
            }
            continue;
        };
        // The smallest scene may fail by another cause, such as corners that touch an edge.
        write_text(
            &folder.join(format!("random-{}-whole.toml", draft.seed)),
            &draft.text(),
        )?;
        let least = draft.reduced(device, folder)?;
        let smallest = least.fails(device, folder)?.unwrap_or_default();
        let what = format!("{whole}; as the smallest scene, {smallest}");
        let file = format!("random-{}.toml", draft.seed);
        write_text(&folder.join(&file), &least.text())?;
        failures.push(Failure {
            seed: draft.seed,
            what,
            file,
        });
    }
    Ok(failures)
}
