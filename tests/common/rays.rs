//! Common code of tests that trace single rays: the solids as their targets.

pub use super::random::Random;
use super::shapes;
use glam::{DVec2, DVec3};
use revmap::profile::Profile;
use revmap::surface::{Frustum, ProxyHull, ProxyHullOptions, QuadricPatch};
use revmap_files::ProfileAxis;
use std::f64::consts::TAU;

/// Profiles by name: those of [`shapes`], and the drawings of chess pieces. The environment
/// variable `ONLY` selects one of them.
pub fn profiles() -> Vec<(String, Profile)> {
    let mut all: Vec<(String, Profile)> = Vec::new();
    all.extend(shapes::all().into_iter().map(|(name, p)| (name.into(), p)));
    for name in ["bishop", "king", "pawn", "rook"] {
        let file = format!("{}/assets/profiles/{name}.svg", env!("CARGO_MANIFEST_DIR"));
        let profile = revmap_files::profile(file, ProfileAxis::Center).unwrap();
        all.push((name.into(), profile));
    }
    if let Ok(only) = std::env::var("ONLY") {
        all.retain(|(name, _)| *name == only);
    }
    all
}

/// An eye around a solid, at most so far above or below it as an angle.
pub fn eye_around(random: &mut Random, most: f64) -> DVec3 {
    let (sin, cos) = ((random.next() * 2.0 - 1.0) * most).sin_cos();
    let (y, x) = (random.next() * 6.3).sin_cos();
    DVec3::new(x * cos, y * cos, sin) * 2.2 + DVec3::Z * 0.5
}

/// True if a point of a patch's quadric is on the patch.
pub fn guards(patch: &QuadricPatch, square: f64, z: f64) -> bool {
    let [cz, cr, low, high] = patch.guard;
    (low..=high).contains(&(cz * z + cr * square))
}

/// True if a ray passes a triangle of a frustum against its normal.
pub fn enters_frustum(frustum: &Frustum, sides: u32, o: DVec3, v: DVec3) -> bool {
    let corner = |step: u32, [r, z]: [f32; 2]| {
        let angle = TAU * f64::from(step) / f64::from(sides);
        (DVec2::from_angle(angle) * f64::from(r)).extend(z.into())
    };
    (0..sides).any(|n| {
        let [a, b] = [n, n + 1].map(|step| corner(step, frustum.from));
        let [c, d] = [n, n + 1].map(|step| corner(step, frustum.to));
        enters(o, v, [a, b, d]) || enters(o, v, [a, d, c])
    })
}

/// True if a ray passes a triangle against its normal.
fn enters(o: DVec3, v: DVec3, [a, b, c]: [DVec3; 3]) -> bool {
    let normal = (b - a).cross(c - a);
    let side = |p: DVec3, q: DVec3| (q - o).cross(p - o).dot(v) >= 0.0;
    normal.dot(v) < 0.0 && normal.dot(a - o) < 0.0 && side(a, b) && side(b, c) && side(c, a)
}

/// A hull with at most so many patches in a cell.
pub fn hull(patches: &[QuadricPatch], patches_per_cell: u32) -> ProxyHull {
    let options = ProxyHullOptions {
        patches_per_cell,
        ..ProxyHullOptions::default()
    };
    ProxyHull::new(patches, &options)
}

/// Number of rays for each solid: the environment variable `RAYS`, or else `usual`.
pub fn count(usual: usize) -> usize {
    std::env::var("RAYS").map_or(usual, |n| n.parse().unwrap())
}
