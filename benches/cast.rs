//! What a ray on the CPU costs: 1,000 random rays at a solid, at 10,000 copies. `cargo bench --bench
//! cast`.
#![allow(clippy::unwrap_used)]

use divan::{Bencher, counter::ItemsCount};
use glam::DVec3;
use revmap::cast::RayCaster;
use revmap::scene::{Object, Placement};
use revmap_files::ProfileAxis;

#[path = "../tests/common/random.rs"]
mod random;
use random::Random;

const RAYS: usize = 1000;

fn main() {
    divan::main();
}

fn object(copies: u32) -> Object {
    let file = concat!(env!("CARGO_MANIFEST_DIR"), "/assets/profiles/bishop.svg");
    let profile = revmap_files::profile(file, ProfileAxis::Center).unwrap();
    let placed = |k: u32| Placement {
        position: DVec3::new(f64::from(k % 100), f64::from(k / 100), 0.0),
        ..Placement::default()
    };
    Object {
        instances: (0..copies).map(placed).collect(),
        ..Object::new("bishop", profile.into())
    }
}

/// Rays from all sides towards points of a box: half of them hit a single bishop.
fn rays(caster: &RayCaster) -> Vec<(DVec3, DVec3)> {
    let [low, high] = caster.bounds().unwrap();
    let (middle, half) = (0.5 * (low + high), 0.5 * (high - low));
    let mut random = Random(1);
    let mut number = || 2.0 * random.next() - 1.0;
    let mut point = |scale: f64| {
        let p = DVec3::new(number(), number(), number());
        middle + p * half * scale
    };
    (0..RAYS)
        .map(|_| {
            let (from, to) = (point(4.0), point(1.0));
            (from, to - from)
        })
        .collect()
}

#[divan::bench(args = [0, 10_000])]
fn cast(bencher: Bencher, copies: u32) {
    let caster = RayCaster::new(&object(copies)).unwrap();
    let rays = rays(&caster);
    let hit = |(from, way): &(DVec3, DVec3)| caster.cast(*from, *way).is_some();
    bencher
        .counter(ItemsCount::new(RAYS))
        .bench(|| rays.iter().filter(|ray| hit(ray)).count());
}
