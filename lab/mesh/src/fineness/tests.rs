#![allow(clippy::unwrap_used)]
use super::super::tests::{CUP, contour, is_closed};
use super::*;
use glam::DVec3;
use revmap::profile::Profile;
use revmap::scene::{Camera, CameraFrame, Offset};
use std::sync::Arc;

const SIZE: (u32, u32) = (320, 240);

/// A foot, a waist with beads, a wide bowl, and a hollow.
fn goblet() -> Vec<[f64; 2]> {
    let outside = |k: u32| {
        let z = f64::from(k) / 200.0;
        let bowl = 0.16 * (1.0 + (6.0 * (z - 0.75)).tanh());
        let foot = 0.3 * (-30.0 * z).exp();
        [0.06 + bowl + foot + 0.012 * (70.0 * z).sin(), z]
    };
    let mut points = vec![[0.0, 0.0]];
    points.extend((0..=200).map(outside));
    points.extend([[0.3, 1.0], [0.25, 0.7], [0.0, 0.65]]);
    points
}

/// Copies of 2 to 2,000 pixels: quads grow with the square root around and along.
#[test]
fn small_copies_have_few_triangles() {
    let contour = contour(&goblet(), &Offset::default());
    let of = |pixels: f64| {
        let mesh = Mesh::within(&contour, 0.25 / pixels);
        assert!(is_closed(&mesh));
        mesh.indices.len() / 3
    };
    let found = [2.0, 8.0, 30.0, 120.0, 500.0, 2000.0].map(of);
    println!("{found:?}");
    assert!(found.windows(2).all(|pair| pair[0] < pair[1]), "{found:?}");
    assert!(
        found[0] <= 100 && found[1] <= 200 && found[5] < 60_000,
        "{found:?}"
    );
}

/// An eye in a hollow, at a wall, at a corner or beside the box: no level is absurd.
#[test]
fn levels_are_bounded_for_eyes_within_boxes() {
    let contour = contour(&CUP, &Offset::default());
    let extent = super::super::tessellation::extent_of(&contour);
    let profile = Arc::new(Profile::polygon(&CUP, 0.6).unwrap());
    let object = Object::new("cup", profile);
    let level = |eye: DVec3| {
        let mut camera = Camera::new(eye, DVec3::new(0.0, 0.0, 0.5));
        camera.fov_y = 50.0;
        let camera = CameraFrame::new(&camera, SIZE.0, SIZE.1).unwrap();
        let sight = Sight::new(&camera, SIZE);
        let shape = (&contour, &extent);
        let levels = Fineness::Pixels(0.25).by_level(&object, shape, &sight);
        levels.first_key_value().map(|(level, _)| *level)
    };
    let hollow = level(DVec3::new(0.0, 0.0, 0.6)).unwrap();
    let outside = level(DVec3::new(0.8, 0.0, 0.6)).unwrap();
    assert!(
        outside < hollow && hollow < FINEST - 6,
        "{outside} {hollow}"
    );
}
