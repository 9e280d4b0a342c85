//! The smallest program: a pawn into a PNG file. `cargo run --release --example smallest`
use glam::DVec3;
use revmap::{gpu::Device, scene::*, settings::Settings};
use revmap_files::ProfileAxis;

/// Draws a pawn into a PNG file.
pub fn picture(file: &str) -> revmap::Result<()> {
    let profile = revmap_files::profile("assets/profiles/pawn.svg", ProfileAxis::Center)?;
    let mut scene = Scene::new(Camera::new(
        DVec3::new(1.6, 0.3, 1.1),
        DVec3::new(0.0, 0.0, 0.5),
    ));
    scene.objects.push(Object::new("pawn", profile.into()));
    let drawn = revmap_offscreen::draw(&Device::open(None)?, &scene, &Settings::default())?;
    revmap_files::write_png(&drawn.frame, file)
}

fn main() -> revmap::Result<()> {
    picture("pawn.png")
}
