//! Errors in pixels of a view: how far silhouettes are from the true outline, below a pixel too, and
//! depths. The reference gives the outline: it can be asked for any ray of the picture.

use glam::DVec2;
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
/// Halvings towards a line that is only looked for to know its direction.
const ROUGH: u32 = 6;
/// Columns and rows in which pixels of the other kind are looked for.
const BESIDE: usize = 2;
/// Of more wrong pixels than this an even part stands for all, with the same part of the right ones.
const MOST_WRONG: usize = 1000;
/// Wrong pixels that are looked at together.
const TOGETHER: usize = 64;
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
pub(crate) struct TruePicture {
    camera: CameraFrame,
    reference: Reference,
}

impl TruePicture {
    /// The picture of this size.
    pub(crate) fn new(scene: &Scene, width: u32, height: u32) -> Result<Self> {
        Ok(Self {
            camera: CameraFrame::new(&scene.camera, width, height)?,
            reference: Reference::new(scene)?,
        })
    }

    /// The distance along the ray through the point `(x, y)`, in pixels from the upper left corner,
    /// to the first hit.
    pub(crate) fn at(&self, x: f64, y: f64) -> Option<f64> {
        let direction = self.camera.direction(x, y);
        let ray = Ray::new(self.camera.eye, direction);
        let hit = self.reference.trace(ray).hit;
        hit.map(|hit| hit.t * direction.length())
    }

    /// How far a pixel's depth is from the true one along its ray, over the size of a pixel there.
    pub(crate) fn off(&self, [truth, frame]: [&Frame; 2], k: usize) -> f64 {
        let direction = self
            .camera
            .pixel(k as u32 % truth.width, k as u32 / truth.width);
        let [there, drawn] = [truth, frame].map(|f| f64::from(f.distance[k]));
        let pixel = self.camera.right.length() * there / direction.length();
        (there - drawn).abs() / pixel
    }

    /// The errors of a frame, whose true one is `truth`.
    pub(crate) fn errors(&self, truth: &Frame, frame: &Frame) -> ViewErrors {
        let [silhouette_p999, silhouette_max] = self.ways(truth, frame);
        let mut depths = self.depths(truth, frame);
        depths.par_sort_unstable_by(f64::total_cmp);
        let rank = (depths.len() * 99).div_ceil(100).checked_sub(1);
        ViewErrors {
            silhouette_p999,
            silhouette_max,
            depth_p99: rank.map_or(0.0, |rank| depths[rank]),
        }
    }

    /// The 99.9th percentile and the largest of the distances of wrong pixels from the outline; right
    /// pixels at it count as 0. Only the largest are looked for, because rays that graze are slow.
    /// Of more than [`MOST_WRONG`] an even part is taken.
    fn ways(&self, truth: &Frame, frame: &Frame) -> [f64; 2] {
        let is_at_outline = |k: &usize| {
            let beside = |n: &usize| k.abs_diff(*n) == 1 || k % w(truth) == n % w(truth);
            around(truth, *k, 1).any(|n| beside(&n) && truth.hits(n) != truth.hits(*k))
        };
        let wrong = |k: &usize| truth.hits(*k) != frame.hits(*k);
        let pixels = (0..truth.pixels()).into_par_iter();
        let edge: Vec<usize> = pixels.clone().filter(is_at_outline).collect();
        let at_most = |k: usize| {
            let other = |n: &&usize| truth.hits(**n) != truth.hits(k);
            let apart = |n: &usize| middle(truth, *n).distance(middle(truth, k));
            let far = edge
                .iter()
                .filter(other)
                .map(apart)
                .fold(f64::INFINITY, f64::min);
            Way { k, far, looks: 0 }
        };
        let wrongs: Vec<usize> = pixels.filter(wrong).collect();
        let step = wrongs.len().div_ceil(MOST_WRONG).max(1);
        let some = wrongs.par_iter().step_by(step);
        let mut ways: Vec<Way> = some.map(|k| at_most(*k)).collect();
        let right = edge.iter().filter(|k| !wrong(k)).count();
        let all = right / step + ways.len();
        let place = all - (all * 999).div_ceil(1000);
        let largest = (place + 1).min(ways.len());
        loop {
            ways.par_sort_unstable_by(|a, b| b.far.total_cmp(&a.far).then(a.k.cmp(&b.k)));
            let known = |way: &Way| way.looks == Way::LOOKS;
            if ways[..largest].iter().all(known) {
                break;
            }
            let open = ways.par_iter_mut().take(largest.max(TOGETHER)).enumerate();
            open.filter(|(n, way)| way.looks == 0 || (*n < largest && !known(way)))
                .for_each(|(_, way)| self.look(truth, way));
        }
        let far = |n: usize| ways.get(n).map_or(0.0, |way| way.far);
        [far(place), far(0)]
    }

    /// Looks closer at the distance of a pixel: first towards the nearest pixels of the other kind,
    /// then around.
    fn look(&self, truth: &Frame, way: &mut Way) {
        let (from, hits) = (middle(truth, way.k), truth.hits(way.k));
        way.looks += 1;
        let other = |place: DVec2| self.at(place.x, place.y).is_some() != hits;
        if way.looks == Way::LOOKS {
            if let Some(found) = nearest(way.far, |aside| other(from + aside)) {
                way.far = way.far.min(found);
            }
            return;
        }
        let mut others: Vec<DVec2> = (around(truth, way.k, BESIDE))
            .filter(|n| truth.hits(*n) != hits)
            .map(|n| middle(truth, n) - from)
            .collect();
        others.sort_by(|a, b| a.length_squared().total_cmp(&b.length_squared()));
        let Some(&first) = others.first() else { return };
        let crossing = |to: DVec2, halvings| first_on(to, halvings, |aside| other(from + aside));
        let one = crossing(first, ROUGH);
        way.far = way.far.min(one.length());
        let beside = |to: &&DVec2| first.normalize().perp_dot(to.normalize()).abs() > 0.3;
        let Some(second) = others.iter().find(beside) else {
            return;
        };
        let along = crossing(*second, ROUGH) - one;
        // The foot of the perpendicular on the line through both.
        let foot = one - along * (one.dot(along) / along.length_squared());
        let to = foot * (1.1 + 0.02 / foot.length().max(1e-6));
        if other(from + to) {
            way.far = way.far.min(crossing(to, HALVINGS).length());
        }
    }

    /// The errors of the distances along rays, over the size of a pixel there.
    fn depths(&self, truth: &Frame, frame: &Frame) -> Vec<f64> {
        let both = |k: &usize| truth.hits(*k) && frame.hits(*k);
        let pixels = (0..truth.pixels()).into_par_iter();
        pixels
            .filter(both)
            .map(|k| self.off([truth, frame], k))
            .collect()
    }
}

/// A wrong pixel.
struct Way {
    k: usize,
    /// Its distance from the outline, at most; pixels.
    far: f64,
    /// How closely it was looked at.
    looks: u32,
}

impl Way {
    const LOOKS: u32 = 2;
}

fn w(frame: &Frame) -> usize {
    frame.width as usize
}

/// The centre of a pixel.
pub(crate) fn middle(frame: &Frame, k: usize) -> DVec2 {
    DVec2::new((k % w(frame)) as f64 + 0.5, (k / w(frame)) as f64 + 0.5)
}

/// The pixels of a frame at most so many columns and rows away from pixel `k`, in order.
pub fn around(frame: &Frame, k: usize, far: usize) -> impl Iterator<Item = usize> + use<> {
    let (width, height) = (w(frame), frame.height as usize);
    let (x, y) = (k % width, k / width);
    let rows = y.saturating_sub(far)..(y + far + 1).min(height);
    let columns = x.saturating_sub(far)..(x + far + 1).min(width);
    rows.flat_map(move |j| columns.clone().map(move |i| j * width + i))
}

/// The first point on the way from the origin to a point at which something is so.
fn first_on(to: DVec2, halvings: u32, is_so: impl Fn(DVec2) -> bool) -> DVec2 {
    let (mut near, mut far) = (0.0, 1.0);
    for _ in 0..halvings {
        let middle = 0.5 * (near + far);
        *(if is_so(middle * to) {
            &mut far
        } else {
            &mut near
        }) = middle;
    }
    far * to
}

/// The distance from the origin to the nearest point at which something is so, pixels; `None` if that
/// is not below `most`, or beyond [`MOST`]. It is not so at the origin.
fn nearest(most: f64, is_so: impl Fn(DVec2) -> bool) -> Option<f64> {
    let step = TAU / f64::from(DIRECTIONS);
    let found = |far: f64| -> Vec<f64> {
        let angles = (0..DIRECTIONS).map(|n| step * f64::from(n));
        angles
            .filter(|a| is_so(far * DVec2::from_angle(*a)))
            .collect()
    };
    let mut far = LEAST;
    let mut angles = found(far);
    while angles.is_empty() && far < most.min(MOST) {
        far *= 2.0;
        angles = found(far);
    }
    let mut best = (*angles.first()?, far);
    // The nearer of the best so far and of another direction.
    let better = |best: (f64, f64), angle: f64| {
        let to = NEARER * best.1 * DVec2::from_angle(angle);
        match is_so(to) {
            true => (angle, first_on(to, HALVINGS, &is_so).length()),
            false => best,
        }
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
    use glam::DVec3;

    /// A half-plane at any distance and angle, a sliver, a disc, and nothing.
    #[test]
    fn the_nearest_point_is_found_in_any_direction() {
        for k in 0..40 {
            let (far, angle) = (0.003 * 1.2f64.powi(k), 0.61 * f64::from(k));
            let way = DVec2::from_angle(angle);
            let found = nearest(MOST, |p| p.dot(way) > far);
            match found {
                Some(found) => assert!((found / far - 1.0).abs() < 2e-3, "{far}: {found}"),
                None => assert!(far > 3.9, "{far}"),
            }
        }
        let sliver = nearest(MOST, |p| p.x > 0.3 && p.x < 0.45).unwrap();
        assert!((sliver / 0.3 - 1.0).abs() < 2e-3, "{sliver}");
        let disc = nearest(MOST, |p| p.distance(DVec2::new(1.0, 1.3)) < 0.9).unwrap();
        assert!((disc - (1.0f64.hypot(1.3) - 0.9)).abs() < 2e-3, "{disc}");
        assert_eq!(nearest(MOST, |_| false), None);
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
