//! Errors in pixels of a view: how far silhouettes are from the true outline, below a pixel too, and
//! depths. The reference gives the outline: it can be asked for any ray of the picture.

use glam::{DVec2, DVec3};
use rayon::prelude::*;
use revmap::error::Result;
use revmap::frame::Frame;
use revmap::scene::{CameraFrame, Scene};
use revmap_reference::{Ray, Reference};
use std::f64::consts::TAU;

/// Directions in which a change is looked for at each distance.
const DIRECTIONS: u32 = 16;
/// The distances looked at, pixels, each twice the one before.
const LEAST: f64 = 1.0 / 64.0;
const MOST: f64 = 4.0;
/// How often a distance is halved, and to which part the step from direction to direction.
const HALVINGS: u32 = 12;
const FINEST: f64 = 1.0 / 64.0;
/// A direction is taken if the way becomes this much shorter.
const NEARER: f64 = 0.999;

/// Errors in pixels of the view.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ViewErrors {
    /// 99.9th percentile of the distances of the silhouette from the true outline (nearest rank).
    /// Each pixel at the true outline and each wrong pixel has one: 0 if the frame is right there,
    /// else the distance from the pixel's centre to the outline.
    pub silhouette_p999: f64,
    /// The largest of these distances.
    pub silhouette_max: f64,
    /// 99th percentile of the error of the distance along the ray, over the size of a pixel there.
    pub depth_p99: f64,
}

/// The true picture of a scene, at any point of it.
#[derive(Debug)]
pub struct TruePicture {
    pub(crate) camera: CameraFrame,
    reference: Reference,
}

impl TruePicture {
    /// The picture of this size.
    ///
    /// # Errors
    /// Those of [`CameraFrame::new`] and [`Reference::new`].
    pub fn new(scene: &Scene, width: u32, height: u32) -> Result<Self> {
        Ok(Self {
            camera: CameraFrame::new(&scene.camera, width, height)?,
            reference: Reference::new(scene)?,
        })
    }

    /// The distance along the ray through the point `(x, y)`, in pixels from the upper left corner,
    /// to the first hit.
    #[must_use]
    pub fn at(&self, x: f64, y: f64) -> Option<f64> {
        let direction = self.camera.direction(x, y);
        let ray = Ray {
            origin: self.camera.eye,
            direction,
        };
        let hit = self.reference.trace(ray).hit;
        hit.map(|hit| hit.t * direction.length())
    }

    /// The distance from a point of the picture to the outline in pixels: to the nearest point that
    /// hits if this one does not, and the reverse. `None` beyond 4 pixels.
    #[must_use]
    pub fn outline_distance(&self, x: f64, y: f64) -> Option<f64> {
        let hits = self.at(x, y).is_some();
        nearest(|aside| self.at(x + aside.x, y + aside.y).is_some() != hits)
    }

    /// The world size of a pixel at a distance along a ray.
    pub(crate) fn pixel(&self, direction: DVec3, distance: f64) -> f64 {
        self.camera.right.length() * distance / direction.length()
    }

    /// The errors of a frame, whose true one is `truth`.
    pub(crate) fn errors(&self, truth: &Frame, frame: &Frame) -> ViewErrors {
        let mut ways = self.ways(truth, frame);
        let mut depths = self.depths(truth, frame);
        ways.par_sort_unstable_by(f64::total_cmp);
        depths.par_sort_unstable_by(f64::total_cmp);
        let rank = |errors: &[f64], part: usize, whole: usize| {
            let rank = (errors.len() * part).div_ceil(whole).checked_sub(1);
            rank.map_or(0.0, |rank| errors[rank])
        };
        ViewErrors {
            silhouette_p999: rank(&ways, 999, 1000),
            silhouette_max: rank(&ways, 1, 1),
            depth_p99: rank(&depths, 99, 100),
        }
    }

    /// The distance of each wrong pixel from the outline, and 0 for each right pixel at it.
    fn ways(&self, truth: &Frame, frame: &Frame) -> Vec<f64> {
        let width = truth.width as usize;
        let place = |k: usize| DVec2::new((k % width) as f64 + 0.5, (k / width) as f64 + 0.5);
        let is_at_outline = |k: usize| {
            let beside = |n: usize| k.abs_diff(n) == 1 || k % width == n % width;
            let other = |n: usize| truth.hits(n) != truth.hits(k);
            around(truth, k, 1).any(|n| beside(n) && other(n))
        };
        let pixels = (0..truth.pixels()).into_par_iter();
        let edge: Vec<usize> = pixels.clone().filter(|k| is_at_outline(*k)).collect();
        let whole = |k: usize| {
            let apart = |n: &usize| place(*n).distance(place(k));
            edge.iter().map(apart).fold(f64::INFINITY, f64::min)
        };
        let way = |k: usize| {
            let mut near = around(truth, k, MOST as usize + 1);
            let near = (near.any(|n| truth.hits(n) != truth.hits(k)))
                .then(|| self.outline_distance(place(k).x, place(k).y));
            // Beyond some pixels whole ones are counted.
            near.flatten().unwrap_or_else(|| whole(k))
        };
        let wrong = |k: &usize| truth.hits(*k) != frame.hits(*k);
        let mut all: Vec<f64> = pixels.filter(wrong).map(way).collect();
        all.extend(edge.iter().filter(|k| !wrong(k)).map(|_| 0.0));
        all
    }

    /// The errors of the distances along rays, over the size of a pixel there.
    fn depths(&self, truth: &Frame, frame: &Frame) -> Vec<f64> {
        let error = |k: usize| {
            let (x, y) = (k as u32 % truth.width, k as u32 / truth.width);
            let [there, drawn] = [truth, frame].map(|f| f64::from(f.distance[k]));
            (there - drawn).abs() / self.pixel(self.camera.pixel(x, y), there)
        };
        let both = |k: &usize| truth.hits(*k) && frame.hits(*k);
        let pixels = (0..truth.pixels()).into_par_iter();
        pixels.filter(both).map(error).collect()
    }
}

/// The pixels at most so many columns and rows away.
fn around(frame: &Frame, k: usize, far: usize) -> impl Iterator<Item = usize> + use<> {
    let (width, height) = (frame.width as usize, frame.height as usize);
    let (x, y) = (k % width, k / width);
    let rows = y.saturating_sub(far)..(y + far + 1).min(height);
    let columns = x.saturating_sub(far)..(x + far + 1).min(width);
    rows.flat_map(move |j| columns.clone().map(move |i| j * width + i))
}

/// The distance from the origin to the nearest point at which something is so, pixels; `None` beyond
/// [`MOST`]. It is not so at the origin.
pub(crate) fn nearest(is_so: impl Fn(DVec2) -> bool) -> Option<f64> {
    let step = TAU / f64::from(DIRECTIONS);
    let found = |far: f64| -> Vec<f64> {
        let angles = (0..DIRECTIONS).map(|n| step * f64::from(n));
        angles
            .filter(|a| is_so(far * DVec2::from_angle(*a)))
            .collect()
    };
    let mut far = LEAST;
    let mut angles = found(far);
    while angles.is_empty() && far < MOST {
        far *= 2.0;
        angles = found(far);
    }
    let mut best = (*angles.first()?, far);
    // The nearer of the best so far and of another direction.
    let better = |best: (f64, f64), angle: f64| {
        let (way, mut near, mut far) = (DVec2::from_angle(angle), 0.0, NEARER * best.1);
        if !is_so(far * way) {
            return best;
        }
        for _ in 0..HALVINGS {
            let middle = 0.5 * (near + far);
            *(if is_so(middle * way) {
                &mut far
            } else {
                &mut near
            }) = middle;
        }
        (angle, far)
    };
    best = angles.into_iter().fold(best, better);
    let mut turn = step;
    while turn > FINEST * step {
        let middle = best.0;
        best = [middle - turn, middle + turn]
            .into_iter()
            .fold(best, better);
        if best.0 == middle {
            turn *= 0.5;
        }
    }
    Some(best.1)
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use crate::pixels::tests::{cylinders, drawn};

    /// A half-plane at any distance and angle, a sliver, a disc, and nothing.
    #[test]
    fn the_nearest_point_is_found_in_any_direction() {
        for k in 0..40 {
            let (far, angle) = (0.003 * 1.2f64.powi(k), 0.61 * f64::from(k));
            let way = DVec2::from_angle(angle);
            let found = nearest(|p| p.dot(way) > far);
            match found {
                Some(found) => assert!((found / far - 1.0).abs() < 2e-3, "{far}: {found}"),
                None => assert!(far > 3.9, "{far}"),
            }
        }
        let sliver = nearest(|p| p.x > 0.3 && p.x < 0.45).unwrap();
        assert!((sliver / 0.3 - 1.0).abs() < 2e-3, "{sliver}");
        let disc = nearest(|p| p.distance(DVec2::new(1.0, 1.3)) < 0.9).unwrap();
        assert!((disc - (1.0f64.hypot(1.3) - 0.9)).abs() < 2e-3, "{disc}");
        assert_eq!(nearest(|_| false), None);
    }

    /// A cylinder that is thicker by a part of a pixel, and one that lacks a corner.
    #[test]
    fn planted_shifts_of_an_outline_are_measured_below_a_pixel() {
        // Oblique, so that centres of pixels lie at all distances from the sides.
        let oblique = |radius: f64| {
            let mut scene = cylinders(radius);
            scene.camera.up = DVec3::new(0.0, 0.3, 1.0);
            scene
        };
        let scene = oblique(0.25);
        let truth = drawn(&scene);
        let picture = TruePicture::new(&scene, truth.width, truth.height).unwrap();
        assert_eq!(picture.errors(&truth, &truth), ViewErrors::default());
        // A pixel of this view at depth 4, and the side of the cylinder a little farther.
        let pixel = 8.0 * 20f64.to_radians().tan() / 150.0;
        for part in [0.2, 0.6] {
            let thick = drawn(&oblique(0.25 + part * pixel));
            let found = picture.errors(&truth, &thick);
            assert!(found.silhouette_max < 1.01 * part, "{found:?}");
            assert!(found.silhouette_max > 0.7 * part, "{found:?}");
            assert!(found.silhouette_p999 <= found.silhouette_max);
        }
        let mut holed = truth.clone();
        for k in 0..holed.pixels() {
            if holed.hits(k) && k as u32 % truth.width < 100 {
                holed.distance[k] = f32::INFINITY;
            }
        }
        let found = picture.errors(&truth, &holed);
        assert!(found.silhouette_max > 6.0 && found.silhouette_max.fract() < 1.0);
        let mut deeper = truth.clone();
        deeper
            .distance
            .iter_mut()
            .for_each(|d| *d *= 1.0 + 0.01 * pixel as f32);
        let found = picture.errors(&truth, &deeper);
        assert!((found.depth_p99 - 0.04).abs() < 0.004, "{found:?}");
        assert_eq!(found.silhouette_max, 0.0);
    }
}
