//! Errors of a frame against the reference, and what of them counts as a fault.
//!
//! A pixel is **wrong** when no solid within the tolerance of the true one could have given it: its
//! ray goes deeper into the solid than the tolerance before the drawn hit (or without one), or the
//! drawn hit is farther from the surface than the tolerance.
//!
//! The tolerance is derived, in object units:
//!
//! - a tenth of a texel of 512 rows: what the maps and the pieces promise;
//! - 8 roundings (2^-24 each) of the extents of the solid and of the picture at its distance;
//! - for a drawn hit, 4 roundings of its distance: of the depth, of the length of the ray's
//!   direction, of their product, and of the reference's own number;
//! - all of it times `(1 + bevel) n`, `n` the most replicas along an axis: so fast `F` changes.
//!
//! A wrong pixel that is missed, or a ghost, is **apart** when the reference hits all of the 3 x 3 pixels
//! about it, or none. No rounding excuses such a hole: a picture with one fails.
//!
//! A colour is a fault, where a pixel is not wrong, when one of its channels is outside of what the
//! 3 x 3 pixels about it have in the reference by more than [`COLOR`]: a shadow's edge may lie a
//! pixel off. To those belong the reference's colours for rays moved aside by the tolerance, and
//! for ways to the lights that begin that far off the surface: a rounded edge shows any of its
//! normals.

use super::case::Step;
use glam::DVec3;
use rayon::prelude::*;
use revmap::error::Result;
use revmap::frame::{CHANNELS, Frame};
use revmap::scene::{CameraFrame, Scene, Shadow};
use revmap_compare::{CompareOptions, Heat, around, compare, heat_map};
use revmap_files::Picture;
use revmap_reference::{Colors, Ray, Reference};

/// A texel of 512 rows, object units.
pub const TEXEL: f64 = 1.0 / 512.0;
/// Largest difference of a linear colour channel that is none. Normals of pieces and of maps differ
/// by up to a degree, which a highlight of shininess 32 shows by so much.
pub const COLOR: f32 = 0.05;
/// Half a unit in the last place of a 32-bit float.
const ROUNDING: f64 = 1.0 / 16_777_216.0;

/// What became of one picture.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Judged {
    /// Pixels that the reference hits.
    pub hits: usize,
    /// Missed pixels, within the tolerance or not.
    pub missed: usize,
    /// Ghost pixels, within the tolerance or not.
    pub ghost: usize,
    /// Pixels that are wrong.
    pub wrong: usize,
    /// Pixels of those that are missed or ghosts, more than a pixel from every contour.
    pub apart: usize,
    /// 99th percentile of the depth error, texels of 512 rows, object units.
    pub depth_p99: Option<f64>,
    /// Error of normals, rms, degrees.
    pub normal_rms: Option<f64>,
    /// Pixels with a number that is NaN or infinite, distances of empty pixels aside.
    pub not_finite: usize,
    /// Rays that ran out of steps.
    pub exhausted: usize,
    /// Pixels whose colour is a fault.
    pub color: usize,
    /// Pixels whose colour in the other stage is a fault; 0 in the first stage that is judged.
    pub stages: usize,
    /// Pixels whose fault is another one than in the frame before; `None` without one.
    pub flicker: Option<usize>,
}

/// The faults of a frame, pixel by pixel.
#[derive(Clone, Debug)]
pub struct Faults {
    /// The error of each faulty pixel's distance, world units: infinite, or 0 for a colour alone.
    pixels: Vec<Option<f64>>,
    /// What errors may differ by: each of two is known to within this.
    tolerance: f64,
}

impl Faults {
    /// Pixels that flicker from this frame to the `next`: faulty in one of them alone, or in both
    /// by errors of distance that differ by more than the tolerances of the two.
    pub fn flicker(&self, next: &Self) -> usize {
        let bound = self.tolerance + next.tolerance;
        let pairs = self.pixels.iter().zip(&next.pixels);
        let flickers = |pair: &(&Option<f64>, &Option<f64>)| match pair {
            (None, None) => false,
            (Some(a), Some(b)) => a != b && (a - b).abs() > bound,
            _ => true,
        };
        pairs.filter(flickers).count()
    }
}

impl Judged {
    /// The faults that count: none in a case that passes.
    pub fn faults(&self) -> usize {
        self.wrong + self.not_finite + self.exhausted + self.color + self.stages
    }

    /// Faults as a part of the pixels that the reference hits.
    pub fn share(&self) -> f64 {
        self.faults() as f64 / self.hits.max(1) as f64
    }

    /// Pixels that flicker as a part of those that the reference hits.
    pub fn flicker_share(&self) -> Option<f64> {
        Some(self.flicker? as f64 / self.hits.max(1) as f64)
    }

    /// Whether the picture passes with at most so many faults, none of them a hole.
    pub fn passes(&self, limit: usize) -> bool {
        let flickers = self.flicker.unwrap_or(0) > limit;
        self.not_finite == 0 && self.apart == 0 && self.faults() <= limit && !flickers
    }
}

impl std::fmt::Display for Judged {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(
            f,
            "{} wrong ({} missed, {} ghost, {} apart from contours), {} with a NaN, {} out of steps, {} of another colour, {} unlike the other stage, {} that flicker, of {} hit",
            self.wrong,
            self.missed,
            self.ghost,
            self.apart,
            self.not_finite,
            self.exhausted,
            self.color,
            self.stages,
            self.flicker.unwrap_or(0),
            self.hits
        )
    }
}

/// A scene's truth: the reference's frame, and the reference itself.
pub struct Truth<'a> {
    /// The reference's frame.
    pub frame: Frame,
    /// Faults that a frame may have and still pass: 1 in 10,000 pixels, and at least 2. On lines
    /// where edges meet or rays run along a face, about one pixel in a hundred is decided by one
    /// rounding, and of `n` pixels of the order of `sqrt(n)` lie on a line.
    pub limit: usize,
    reference: Reference,
    painter: Colors<'a>,
    camera: CameraFrame,
    eye: DVec3,
    /// If the eye is in a solid: the solids around it, and the others.
    inside: Option<[Reference; 2]>,
    /// Tolerances, object units: of a silhouette, of a drawn hit.
    tolerance: [f64; 2],
    /// World length of a texel.
    texel: f64,
    /// Whether the reference's colours are the truth: soft shadows have none.
    colors: bool,
}

impl<'a> Truth<'a> {
    /// Draws the reference of a step's scene.
    pub fn new(scene: &'a Scene, step: &Step) -> Result<Self> {
        let frame = revmap_reference::draw(scene, &step.settings, &|_, _| {})?;
        let reference = Reference::new(scene)?;
        let camera = CameraFrame::new(&scene.camera, frame.width, frame.height)?;
        let eye = scene.camera.eye;
        let here = Ray::new(eye, camera.forward);
        let half_diagonal = camera.middle[0].hypot(camera.middle[1]) * camera.right.length();
        let (mut extent, mut distance, mut texel) = (0.0f64, 0.0f64, f64::INFINITY);
        let mut rate = 1.0f64;
        for object in &scene.objects {
            let cells = object.repeat.into_iter().max().unwrap_or(1);
            rate = rate.max((1.0 + object.offset.bevel) * f64::from(cells));
            for copy in object.placements() {
                let local = copy.rotation.conjugate() * (eye - copy.position) / copy.scale;
                let far = (local - DVec3::new(0.0, 0.0, 0.5)).length();
                let size = object.profile.radius.hypot(0.5);
                distance = distance.max(far + size);
                extent = extent.max(size + half_diagonal * far.min(1e9));
                texel = texel.min(TEXEL * copy.scale.min_element());
            }
        }
        let silhouette = 0.1 * TEXEL + 8.0 * ROUNDING * extent;
        Ok(Self {
            inside: (reference.clearance_within(here, [0.0, 0.0], 1e-9) < 0.0)
                .then(|| reference.split_at(eye)),
            limit: (frame.pixels() / 10_000).max(2),
            frame,
            painter: Colors::new(scene)?,
            reference,
            camera,
            eye,
            tolerance: [silhouette, silhouette + 4.0 * ROUNDING * distance].map(|t| rate * t),
            texel: if texel.is_finite() { texel } else { TEXEL },
            colors: scene.shadow != Shadow::Soft,
        })
    }

    /// Errors in texels of 512 rows of the smallest object, without FLIP.
    fn options(&self) -> CompareOptions {
        CompareOptions {
            texel: self.texel,
            flip: false,
        }
    }

    /// Where a frame's depths are wrong.
    pub fn heat(&self, frame: &Frame) -> Result<Picture> {
        heat_map(&self.frame, frame, &self.options(), Heat::Depth)
    }

    /// Judges a frame, with the faults of each pixel; `other` is the other stage's.
    pub fn judge(&self, frame: &Frame, other: Option<&Frame>) -> Result<(Judged, Faults)> {
        let errors = compare(&self.frame, frame, &self.options())?;
        let pixels = (0..frame.pixels()).into_par_iter();
        let wrong: Vec<bool> = pixels.map(|k| self.is_wrong(frame, k)).collect();
        let unlike = |truth: &Frame| {
            (0..frame.pixels())
                .filter(|&k| !wrong[k] && is_strange(truth, frame, k, colors_about(truth, k)))
                .count()
        };
        let strange = self.strange(frame, &wrong);
        let error = |k: usize| {
            let off = f64::from(frame.distance[k]) - f64::from(self.frame.distance[k]);
            (wrong[k] || strange[k]).then_some(if strange[k] { 0.0 } else { off })
        };
        let faults = Faults {
            pixels: (0..wrong.len()).map(error).collect(),
            tolerance: self.tolerance[1] * self.texel / TEXEL,
        };
        let judged = Judged {
            hits: errors.hits,
            missed: errors.missed,
            ghost: errors.ghost,
            wrong: wrong.iter().filter(|w| **w).count(),
            apart: (0..wrong.len())
                .filter(|&k| wrong[k] && self.is_apart(frame, k))
                .count(),
            depth_p99: errors.depth.map(|d| d.p99),
            normal_rms: errors.normal.map(|n| n.rms),
            not_finite: not_finite(frame),
            exhausted: frame.exhausted,
            color: strange.iter().filter(|s| **s).count(),
            stages: other.map_or(0, unlike),
            flicker: None,
        };
        Ok((judged, faults))
    }

    /// Which pixels are not wrong but for their colour.
    fn strange(&self, frame: &Frame, wrong: &[bool]) -> Vec<bool> {
        let is = |k: usize| {
            let mut range = colors_about(&self.frame, k);
            if !self.colors || wrong[k] || !is_strange(&self.frame, frame, k, range) {
                return false;
            }
            let Ray { origin, direction } = self.ray(k);
            let far = self.tolerance[1] * self.texel / TEXEL;
            let (right, up) = (
                self.camera.right.normalize_or_zero(),
                self.camera.up.normalize_or_zero(),
            );
            let moved = [right, -right, up, -up].map(|aside| (origin + far * aside, 0.0));
            for (origin, lift) in moved.into_iter().chain([(origin, far)]) {
                let color = (self.painter).along(&self.reference, Ray { origin, direction }, lift);
                if let Some(color) = color {
                    widen(&mut range, color);
                }
            }
            is_strange(&self.frame, frame, k, range)
        };
        (0..frame.pixels()).into_par_iter().map(is).collect()
    }

    /// The ray through the middle of pixel `k`, its direction of length 1.
    fn ray(&self, k: usize) -> Ray {
        let width = self.frame.width as usize;
        let pixel = self.camera.pixel((k % width) as u32, (k / width) as u32);
        Ray::new(self.eye, pixel.normalize())
    }

    /// True if the frame alone hits or misses at pixel `k`, where the 3 x 3 pixels about it are alike.
    fn is_apart(&self, frame: &Frame, k: usize) -> bool {
        let truth = &self.frame;
        let alike = |n| truth.hits(n) == truth.hits(k);
        frame.hits(k) != truth.hits(k) && around(truth, k, 1).all(alike)
    }

    fn is_wrong(&self, frame: &Frame, k: usize) -> bool {
        let (hit, drawn) = (self.frame.hits(k), frame.hits(k));
        let (truth, z) = (
            f64::from(self.frame.distance[k]),
            f64::from(frame.distance[k]),
        );
        if !hit && !drawn || truth == z {
            return false;
        }
        // Where cells or boxes cut a solid, the clearance does not tell how near the true point is.
        if hit && drawn && (z - truth).abs() <= 0.1 * self.texel {
            return false;
        }
        let ray = self.ray(k);
        let [silhouette, tolerance] = self.tolerance;
        let fine = 0.05 * silhouette;
        if drawn {
            // A hit on a face between cells may be rounded into a cell that is not solid there.
            let about = [z * (1.0 - 4.0 * ROUNDING), z * (1.0 + 4.0 * ROUNDING)];
            if !self.reference.goes_deeper(ray, about, -tolerance, fine) {
                return true;
            }
            if let Some([around, others]) = &self.inside {
                // From within all is solid before the hit: what counts is the distance to the true
                // hit's tangent plane, in units of the smallest object.
                let n = DVec3::from(self.frame.normal[k].map(f64::from));
                let steep = n.dot(ray.direction).abs().max(0.02);
                let is_at = |t: f64| (z - t).abs() * steep * TEXEL / self.texel <= 4.0 * tolerance;
                if hit && is_at(truth) {
                    return false;
                }
                // Another solid may be grazed before the ray leaves those around the eye: then both
                // are right, the grazed surface and the one behind it.
                let leaves = around.trace(ray).hit.map_or(f64::INFINITY, |hit| hit.t);
                let grazes = z <= leaves && others.goes_deeper(ray, about, -tolerance, fine);
                return !(grazes || is_at(leaves))
                    || others.goes_deeper(ray, [0.0, z], tolerance, fine);
            }
            return hit && z > truth && self.reference.goes_deeper(ray, [0.0, z], tolerance, fine);
        }
        if self.inside.is_some() {
            return true;
        }
        self.reference
            .goes_deeper(ray, [0.0, f64::INFINITY], silhouette, fine)
    }
}

fn not_finite(frame: &Frame) -> usize {
    let bad = |(name, v): (&&str, f32)| !(v.is_finite() || *name == "Z" && v == f32::INFINITY);
    let pixels = (0..frame.pixels()).into_par_iter();
    pixels
        .filter(|&k| CHANNELS.iter().zip(frame.pixel(k)).any(bad))
        .count()
}

/// The least and the largest of each colour channel.
type ColorRange = [[f32; 2]; 3];

/// The colours of the 3 x 3 pixels about pixel `k`.
fn colors_about(frame: &Frame, k: usize) -> ColorRange {
    let mut range = [[f32::INFINITY, f32::NEG_INFINITY]; 3];
    around(frame, k, 1).for_each(|n| widen(&mut range, frame.color[n]));
    range
}

fn widen(range: &mut ColorRange, color: [f32; 4]) {
    for ([low, high], v) in range.iter_mut().zip(color) {
        (*low, *high) = (low.min(v), high.max(v));
    }
}

/// Whether both frames hit at pixel `k`, but the colour of `frame` is outside of a range.
fn is_strange(truth: &Frame, frame: &Frame, k: usize, range: ColorRange) -> bool {
    let within = |([low, high], v): (&[f32; 2], f32)| (low - COLOR..=high + COLOR).contains(&v);
    frame.hits(k) && truth.hits(k) && !range.iter().zip(frame.color[k]).all(within)
}
