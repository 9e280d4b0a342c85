//! Errors of silhouettes and depths in pixels of a view: what a tolerance bounds.

use crate::outline::{TruePicture, around, middle};
use glam::DVec2;
use rayon::prelude::*;
use revmap::error::Result;
use revmap::frame::Frame;
use revmap::scene::Scene;
use std::f64::consts::TAU;

/// Depths that differ by more pixels than this, where a neighbour of the reference has a nearer
/// one, are a contour that has moved.
const JUMP: f64 = 4.0;

/// Directions in which the contour is looked for, and how often the distance is halved.
const DIRECTIONS: u32 = 16;
const HALVINGS: u32 = 4;
/// The distances looked at, pixels, each twice the one before; the last stands for all beyond.
const LEAST: f64 = 1.0 / 256.0;
const MOST: f64 = 4.0;

/// What moved by how much, pixels.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct PixelErrors {
    /// Pixels that hit in either frame.
    pub pixels: usize,
    /// Of these, pixels on the wrong side of a silhouette, or of one solid before another.
    pub moved: usize,
    /// The error that 99.9 % of the pixels do not exceed: of the depth along the ray over the size
    /// of a pixel there, or how far the contour has moved.
    pub p999: f64,
    /// The largest of the others.
    pub contour_max: f64,
}

/// Errors of a drawn frame of `scene`.
pub fn pixel_errors(scene: &Scene, truth: &Frame, frame: &Frame) -> Result<PixelErrors> {
    let picture = TruePicture::new(scene, truth.width, truth.height)?;
    let errors: Vec<(f64, bool)> = (0..truth.pixels())
        .into_par_iter()
        .filter(|&k| truth.hits(k) || frame.hits(k))
        .map(|k| {
            let [there, drawn] = [truth, frame].map(|f| f64::from(f.distance[k]));
            let off = picture.off([truth, frame], k);
            let beside = |place: f64| (place - drawn).abs() <= 0.5 * (there - drawn).abs();
            // Whether what is drawn is nearer to what the reference has beside it.
            let is_near = || around(truth, k, 1).any(|n| beside(f64::from(truth.distance[n])));
            if truth.hits(k) && frame.hits(k) && !(off > JUMP && is_near()) {
                return (off, false);
            }
            // What the reference shows nearby, on the other side of the contour.
            let shows = |aside: DVec2| {
                let place = middle(truth, k) + aside;
                match picture.at(place.x, place.y) {
                    None => !frame.hits(k),
                    Some(_) if !frame.hits(k) => false,
                    Some(place) => !truth.hits(k) || beside(place),
                }
            };
            (way_to(shows), true)
        })
        .collect();
    let mut all: Vec<f64> = errors.iter().map(|e| e.0).collect();
    all.sort_unstable_by(f64::total_cmp);
    let moved = || errors.iter().filter(|e| e.1);
    let rank = (all.len() * 999).div_ceil(1000).checked_sub(1);
    Ok(PixelErrors {
        pixels: all.len(),
        moved: moved().count(),
        p999: rank.map_or(0.0, |rank| all[rank]),
        contour_max: moved().map(|e| e.0).fold(0.0, f64::max),
    })
}

/// How far from a pixel's middle something is shown, pixels. Flights ask it of thousands of pixels of
/// crowds, so it takes a tenth of the rays of [`nearest`](crate::outline::nearest).
fn way_to(shows: impl Fn(DVec2) -> bool) -> f64 {
    let step = TAU / f64::from(DIRECTIONS);
    let around =
        |far: f64| (0..DIRECTIONS).any(|n| shows(far * DVec2::from_angle(step * f64::from(n))));
    let mut far = LEAST;
    while far < MOST && !around(far) {
        far *= 2.0;
    }
    let mut near = 0.5 * far;
    for _ in 0..HALVINGS {
        let middle = 0.5 * (near + far);
        *(if around(middle) { &mut far } else { &mut near }) = middle;
    }
    far
}

#[cfg(test)]
pub(crate) mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use glam::DVec3;
    use revmap::profile::Profile;
    use revmap::scene::{Camera, Object};
    use revmap::settings::Settings;
    use std::sync::Arc;

    /// A cylinder before another that is wider, farther away.
    pub(crate) fn cylinders(radius: f64) -> Scene {
        let eye = DVec3::new(4.0, 0.0, 0.5);
        let mut scene = Scene::new(Camera::new(eye, DVec3::new(0.0, 0.0, 0.5)));
        for (r, x) in [(radius, 0.0), (0.45, -3.0)] {
            let points = [[0.0, 0.0], [r, 0.0], [r, 1.0], [0.0, 1.0]];
            let profile = Profile::polygon(&points, 0.5).unwrap();
            let mut object = Object::new("cylinder", Arc::new(profile));
            object.placement.position.x = x;
            scene.objects.push(object);
        }
        scene
    }

    pub(crate) fn drawn(scene: &Scene) -> Frame {
        let settings = Settings {
            width: 200,
            height: 150,
            ..Settings::exact()
        };
        revmap_reference::draw(scene, &settings, &|_, _| {}).unwrap()
    }

    #[test]
    fn planted_errors_are_measured_in_pixels() {
        let scene = cylinders(0.25);
        let truth = drawn(&scene);
        let none = pixel_errors(&scene, &truth, &truth).unwrap();
        assert_eq!((none.moved, none.p999, none.contour_max), (0, 0.0, 0.0));
        assert!(none.pixels > 1000);
        // A pixel of this view at depth 4: 8 tan(20 degrees) / 150.
        let pixel = 8.0 * 20f64.to_radians().tan() / 150.0;
        let mut deeper = truth.clone();
        for distance in &mut deeper.distance {
            *distance *= 1.0 + 0.01 * pixel as f32;
        }
        let found = pixel_errors(&scene, &truth, &deeper).unwrap();
        assert_eq!(found.moved, 0);
        assert!((found.p999 - 0.04).abs() < 0.004, "{found:?}");
        // A pixel thicker: contours before the sky and before the other cylinder move by that.
        let thick = drawn(&cylinders(0.25 + pixel));
        let found = pixel_errors(&scene, &truth, &thick).unwrap();
        assert!(found.moved > 60, "{found:?}");
        assert!((0.5..1.1).contains(&found.contour_max), "{found:?}");
    }
}
