//! What a ray on the CPU costs: 1,000 random rays at a solid, at 10,000 copies. `cargo bench --bench
//! cast`.
#![allow(clippy::unwrap_used)]

use divan::{Bencher, counter::ItemsCount};
use glam::DVec3;
use revmap::cast::RayCaster;
use revmap::scene::{Object, Placement};
use revmap_files::ProfileAxis;

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
    let mut state = 1u64;
    let mut number = || {
        state = state
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1);
        (state >> 40) as f64 / f64::from(1 << 23) - 1.0
    };
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
