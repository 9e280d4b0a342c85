//! Levels of detail of the mesh baseline: each copy is drawn by the mesh that its height on the
//! screen asks for, and copies beside the picture are left out without a trace.

use super::mesh::{draw, settings};
use super::scenes::{eye, placement, scene_of};
use crate::shapes;
use revmap::frame::Frame;
use revmap::scene::Scene;
use revmap_lab::method::{Method, MethodSettings};

fn levels() -> MethodSettings {
    settings(3, 2).by(Method::MeshLevels)
}

/// Pixels in which colours differ.
fn apart(a: &Frame, b: &Frame) -> usize {
    a.color.iter().zip(&b.color).filter(|(a, b)| a != b).count()
}

#[test]
fn a_copy_is_drawn_by_the_mesh_of_its_height() {
    let mut found = Vec::new();
    // Some 25, 85 and 190 of 180 pixels high.
    for distance in [10.0, 3.2, 1.8] {
        let mut scene = scene_of(shapes::vase(), eye(10.0, distance));
        scene.objects[0].instances = vec![placement([0.0; 3], [0.0; 3], [1.0; 3])].into();
        let frame = draw(&scene, &levels());
        assert!(frame.pixels() > 0 && (0..frame.pixels()).any(|k| frame.hits(k)));
        let same = Method::MESH_LEVELS.map(|(segments, rings, _)| {
            apart(&frame, &draw(&scene, &settings(segments, rings))) == 0
        });
        found.push(same);
    }
    let wanted = [0, 1, 2].map(|n| [0, 1, 2].map(|k| n == k));
    assert_eq!(found, wanted);
}

#[test]
fn copies_beside_the_picture_leave_no_trace() {
    let of = |count: usize| {
        let mut scene: Scene = scene_of(shapes::vase(), eye(10.0, 4.0));
        // The first in view; the others behind the eye, to its left and far below.
        let places = [
            [0.0; 3],
            [9.0, 3.7, 0.0],
            [0.0, -40.0, 0.0],
            [0.0, 0.0, -30.0],
        ];
        let copies = places[..count].iter();
        scene.objects[0].instances = copies.map(|&p| placement(p, [0.0; 3], [1.0; 3])).collect();
        draw(&scene, &levels())
    };
    let (one, all) = (of(1), of(4));
    assert_eq!(apart(&one, &all), 0);
    // Had the copy in view been left out, both would be empty.
    assert!((0..one.pixels()).any(|k| one.hits(k)));
}
