//! Draw paths of objects (cells, boxes or walks), and the difference of two frames.

use super::device;
use revmap::frame::Frame;
use revmap::gpu::DrawPath;
use revmap::scene::Scene;
use revmap::settings::{DrawStage, Settings};

pub const STAGES: [DrawStage; 2] = [DrawStage::Fragment, DrawStage::Compute];

/// The expected draw paths of a scene's objects, in either stage.
pub type Ways<'a> = [&'a [DrawPath]; 2];

/// Drawn by cells if the stage has them, and by the tree only.
pub const WRAPPED: Ways<'static> = [&[DrawPath::Cells], &[DrawPath::Walk]];
pub const WALKED: Ways<'static> = [&[DrawPath::Box], &[DrawPath::Walk]];

/// Counts pixels with a hit, pixels that only one frame hits, and pixels whose hits are farther
/// apart than half a texel of 512 rows.
pub fn apart(a: &Frame, b: &Frame) -> (usize, usize, usize) {
    let both = || a.distance.iter().zip(&b.distance);
    let hits = both().filter(|(a, _)| a.is_finite());
    let edge = both().filter(|(a, b)| a.is_finite() != b.is_finite());
    // The difference of two infinities is no number, and that of one is an edge.
    let finite = both().filter(|(a, b)| (*a - *b).is_finite());
    let far = finite.filter(|(a, b)| (*a - *b).abs() > 0.5 / 512.0);
    (hits.count(), edge.count(), far.count())
}

/// Draws, and fails if an object is drawn by another path: the picture would be right, but would
/// test nothing.
#[track_caller]
pub fn draw_by(name: &str, scene: &Scene, settings: &Settings, ways: Ways) -> Frame {
    let drawn = revmap_offscreen::draw(device(), scene, settings).unwrap();
    let stage = usize::from(settings.stage == DrawStage::Compute);
    let name = format!("{name}, {:?}", settings.stage);
    assert_eq!(drawn.draw_paths, ways[stage], "{name}");
    drawn.frame
}
