//! Outlines for tests: plain shapes, and random ones that never cross themselves.

#![allow(dead_code)] // the reference takes all, the library some

use super::random::{Random, on_half_turn};
use glam::DVec2;
use revmap::profile::Outline;

fn outline(points: impl IntoIterator<Item = (f64, f64)>) -> Outline {
    Outline {
        loops: vec![points.into_iter().map(DVec2::from).collect()],
    }
}

/// A cylinder of radius `r` between two heights.
pub(crate) fn cylinder(r: f64, low: f64, high: f64) -> Outline {
    outline([(0.0, low), (r, low), (r, high), (0.0, high)])
}

/// A cone: base radius `r` at `low`, tip at `high`.
pub(crate) fn cone(r: f64, low: f64, high: f64) -> Outline {
    outline([(0.0, low), (r, low), (0.0, high)])
}

/// A ball of `n` segments from pole to pole.
pub(crate) fn ball(radius: f64, n: usize) -> Outline {
    outline((0..=n).map(|k| on_half_turn(k, n, radius).into()))
}

/// A torus: ring radius 0.3, tube radius 0.12, 40 segments.
pub(crate) fn torus() -> Outline {
    outline((0..40).map(|k| {
        let angle = f64::from(k) * std::f64::consts::TAU / 40.0;
        (0.3 + 0.12 * angle.cos(), 0.5 + 0.12 * angle.sin())
    }))
}

/// A thin-walled glass with foot and stem.
pub(crate) fn glass() -> Outline {
    outline([
        (0.0, 0.02),
        (0.28, 0.02),
        (0.28, 0.05),
        (0.05, 0.09),
        (0.04, 0.4),
        (0.2, 0.5),
        (0.32, 0.7),
        (0.3, 0.97),
        (0.28, 0.97),
        (0.3, 0.7),
        (0.19, 0.52),
        (0.0, 0.44),
    ])
}

/// A solid with a closed cavity and a ring apart from it.
pub(crate) fn hollow() -> Outline {
    let mut hollow = outline([(0.0, 0.1), (0.3, 0.1), (0.35, 0.5), (0.2, 0.8), (0.0, 0.8)]);
    let cavity = outline([(0.0, 0.7), (0.15, 0.7), (0.25, 0.5), (0.2, 0.2), (0.0, 0.2)]);
    let ring = outline([(0.4, 0.4), (0.46, 0.4), (0.46, 0.6), (0.4, 0.6)]);
    hollow.loops.extend([cavity.loops, ring.loops].concat());
    hollow
}

/// A random solid: star-shaped about a point on or off the axis, or a stack of discs, depending on
/// `seed`.
pub(crate) fn random(seed: u64) -> Outline {
    let mut random = Random(seed.wrapping_mul(0x9e37_79b9_7f4a_7c15) ^ 0x1234_5678_9abc_def1);
    let count = 3 + random.below(9);
    outline(random.polygon(seed % 3, count).into_iter().map(Into::into))
}
