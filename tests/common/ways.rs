//! How objects are drawn, by cells, tiles or boxes, and how far two frames are apart.

use super::device;
use revmap::frame::Frame;
use revmap::gpu::{self, DrawPath};
use revmap::scene::Scene;
use revmap::settings::{DrawStage, Settings};

pub const STAGES: [DrawStage; 2] = [DrawStage::Fragment, DrawStage::Compute];

/// How a scene's objects are to be drawn, in either stage.
pub type Ways<'a> = [&'a [DrawPath]; 2];

/// By cells where the stage has them, and by the tree alone.
pub const WRAPPED: Ways<'static> = [&[DrawPath::Cells], &[DrawPath::Tiles]];
pub const WALKED: Ways<'static> = [&[DrawPath::Tiles], &[DrawPath::Tiles]];

/// Pixels hit, those that one frame hits and the other not, and those that are seen farther apart
/// than half a texel of 512 rows.
pub fn apart(a: &Frame, b: &Frame) -> (usize, usize, usize) {
    let both = || a.distance.iter().zip(&b.distance);
    let hits = both().filter(|(a, _)| a.is_finite()).count();
    let edge = both()
        .filter(|(a, b)| a.is_finite() != b.is_finite())
        .count();
    let far = both()
        .filter(|(a, b)| a.is_finite() && b.is_finite() && (*a - *b).abs() > 0.5 / 512.0)
        .count();
    (hits, edge, far)
}

/// Draws, and wants every object drawn in that way: another would be right too, and test nothing.
#[track_caller]
pub fn draw_by(name: &str, scene: &Scene, settings: &Settings, ways: Ways) -> Frame {
    let drawn = gpu::draw(device(), scene, settings).unwrap();
    let stage = usize::from(settings.stage == DrawStage::Compute);
    // SwiftShader clips no triangles: there tiles draw what the box cuts.
    let narrow = device().report().name.contains("SwiftShader");
    if !(narrow && drawn.draw_paths == WALKED[stage]) {
        assert_eq!(
            drawn.draw_paths, ways[stage],
            "{name}, {:?}",
            settings.stage
        );
    }
    drawn.frame
}
