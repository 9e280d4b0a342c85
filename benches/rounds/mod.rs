//! Frames of several renderers in rounds, one after the other, in pictures of 800x600.

#[path = "../../tests/common/host.rs"]
#[allow(unused_imports)]
pub mod host;

use glam::DVec3;
use host::Options;
use revmap::gpu::{Renderer, View};
use revmap::scene::{Camera, Scene};
use std::time::Instant;

pub const OPTIONS: Options = Options::new(800, 600);
const ROUNDS: usize = 41;

/// A renderer and its name.
pub type Case = (String, Renderer);

/// A scene and its view.
pub fn bishop() -> (Scene, View) {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/assets/scenes/bishop.toml");
    let mut scene = revmap_files::scene(path).unwrap();
    scene.camera = Camera::new(DVec3::new(1.6, 0.5, 1.0), DVec3::new(0.0, 0.0, 0.5));
    let view = host::view_of(&scene, &OPTIONS);
    (scene, view)
}

/// Draws the rounds by `frame`, which gets the number of a case. Prints medians of the milliseconds of
/// its frames, and of the ratios to the first case's; the first round does not count.
pub fn compare(prefix: &str, cases: &mut [Case], frame: impl Fn(usize, &mut Case)) {
    let mut times = vec![Vec::new(); cases.len()];
    for round in 0..ROUNDS {
        for (n, case) in cases.iter_mut().enumerate() {
            let begin = Instant::now();
            frame(n, case);
            if round > 0 {
                times[n].push(1e3 * begin.elapsed().as_secs_f64());
            }
        }
    }
    let median = |mut all: Vec<f64>| {
        all.sort_unstable_by(f64::total_cmp);
        all[all.len() / 2]
    };
    for ((name, _), own) in cases.iter().zip(&times) {
        let ratios = own.iter().zip(&times[0]).map(|(a, b)| a / b).collect();
        let (time, ratio) = (median(own.clone()), median(ratios));
        println!("{prefix}{time:6.2} ms {ratio:5.2} {name}");
    }
}
