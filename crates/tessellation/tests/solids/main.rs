//! Triangles against the reference in double precision, and against closed forms.
#![allow(clippy::unwrap_used)]

mod coordinates;
mod distances;
mod edges;
#[path = "../../../../tests/common/random.rs"]
mod random;

use glam::DVec3;
use revmap::profile::Profile;
use revmap::scene::{Object, Scene};
use revmap_tessellation::Triangles;
use std::sync::Arc;

const SCENES: [&str; 12] = [
    "bell", "bishop", "bottle", "goblet", "king", "pawn", "ridges", "ring", "rook", "sphere",
    "spindle", "vase",
];

fn scene(name: &str) -> Scene {
    let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/../../assets/scenes");
    revmap_files::scene(format!("{folder}/{name}.toml")).unwrap()
}

fn object(points: &[[f64; 2]]) -> Object {
    Object::new("polygon", Arc::new(Profile::polygon(points, 0.5).unwrap()))
}

fn corners(mesh: &Triangles) -> Vec<[DVec3; 3]> {
    let place = |k: &u32| DVec3::from(mesh.vertices[*k as usize].position.map(f64::from));
    let of = |t: &[u32]| [place(&t[0]), place(&t[1]), place(&t[2])];
    mesh.indices.chunks_exact(3).map(of).collect()
}

fn volume(mesh: &Triangles) -> f64 {
    let of = |[a, b, c]: &[DVec3; 3]| a.dot(b.cross(*c)) / 6.0;
    corners(mesh).iter().map(of).sum()
}
