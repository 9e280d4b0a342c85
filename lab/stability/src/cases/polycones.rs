//! Shapes like those of the tests of polycones in detector geometry (Geant4, ROOT, VecGeom), and
//! rays that such tests shoot: along edges and faces, from near a surface, out of a wall and back.

use super::{MIDDLE, Scene, cylinder, eye, on_half_turn};
use crate::case::Step;

/// The polygon of rows of z, inner and outer radius, upwards.
fn sections(rows: &[[f64; 3]]) -> Vec<[f64; 2]> {
    let outer = rows.iter().map(|&[z, _, r]| [r, z]);
    outer
        .chain(rows.iter().rev().map(|&[z, r, _]| [r, z]))
        .collect()
}

/// Five sections with inner radii; planes that are `gap` apart stand where radii jump.
fn steps(gap: f64) -> Vec<[f64; 2]> {
    sections(&[
        [0.1, 0.1, 0.3],
        [0.3 - gap, 0.1, 0.3],
        [0.3, 0.2, 0.45],
        [0.5 - gap, 0.2, 0.45],
        [0.5, 0.05, 0.25],
        [0.7, 0.15, 0.35],
        [0.9, 0.15, 0.2],
    ])
}

pub(super) const SCENES: &[Scene] = &[
    ("jar-from-above", |rows| {
        let jar = [[0.0, 0.1], [0.4, 0.1], [0.4, 0.6], [0.0, 0.62]];
        let rows = rows as u32;
        Step::seen([-1.6, 0.7, 2.2], MIDDLE)
            .solid(&jar, "")
            .sized(rows * 4 / 3, rows)
    }),
    ("thin-ring", |distance| {
        let ring = [[0.03123, 0.81413], [0.03481, 0.75536], [0.20421, 0.8031]];
        let (x, z) = (0.3 * distance, 0.81 + distance);
        Step::through([x, 0.1 * distance, z], [0.0, 0.0, 0.79], 50.0)
            .solid(&ring, "")
            .sized(400, 300)
    }),
    ("tip-on-the-axis", |width| {
        let cone = [[0.0, 0.25], [0.25, 0.25], [0.0, 0.75]];
        let fov = 2.0 * (0.25 * width).atan().to_degrees();
        Step::through([0.0, 0.0, 2.75], [0.0, 0.0, 0.75], fov)
            .solid(&cone, "")
            .sized(161, 121)
    }),
    ("stretched-and-turned", |by| {
        let keys = format!(
            "scale = {:?}\nrotation = [0.3, -0.2, 0.5, 0.79]",
            [1.0, by, by]
        );
        let eye = eye(25.0, 1.9).map(|x| by * x);
        Step::seen(eye, [0.0; 3]).solid(&steps(0.0), &keys)
    }),
    ("wide-polygon", |ratio| {
        let (r, z) = (0.45, 0.45 / ratio);
        let polygon = [[0.0, 0.5], [r, 0.5], [0.8 * r, 0.5 + z], [0.0, 0.5 + z]];
        Step::seen([1.5, 0.6, 1.1], MIDDLE).solid(&polygon, "")
    }),
    ("small-in-its-box", |part| {
        let points: Vec<_> = steps(0.0)
            .into_iter()
            .map(|p| p.map(|x| part * x))
            .collect();
        let [eye, target] = [eye(25.0, 1.9), MIDDLE].map(|p| p.map(|x| part * x));
        Step::seen(eye, target).solid(&points, "")
    }),
    ("section-without-thickness", |thick| {
        let [low, high] = [0.5 - 0.5 * thick, 0.5 + 0.5 * thick];
        let rows = [
            [0.1, 0.0, 0.2],
            [low, 0.0, 0.2],
            [low, 0.0, 0.4],
            [high, 0.0, 0.4],
            [high, 0.0, 0.2],
            [0.9, 0.0, 0.2],
        ];
        Step::seen(eye(25.0, 1.9), MIDDLE).solid(&sections(&rows), "")
    }),
    ("identical-planes", |gap| {
        Step::seen(eye(25.0, 1.9), MIDDLE).solid(&steps(gap), "")
    }),
    ("touching-cylinders", |gap| {
        Step::seen(eye(25.0, 1.9), MIDDLE)
            .solid(&cylinder(0.3, 0.1, 0.5 - gap), "")
            .solid(&cylinder(0.45, 0.5, 0.7), "")
            .solid(&cylinder(0.3, 0.4, 0.9), "")
    }),
    ("feather-edge", |wall| {
        let rows = [[0.1, 0.05, 0.4], [0.5, 0.3, 0.35], [0.9, 0.3 - wall, 0.3]];
        Step::seen(eye(35.0, 1.7), MIDDLE).solid(&sections(&rows), "")
    }),
    ("nearly-level-cones", |climb| {
        let [c, d] = [0.45 * climb, 0.9 * climb];
        let polygon = [[0.0, 0.5], [0.45, 0.5 - c], [0.45, 0.6], [0.0, 0.6 + d]];
        Step::seen([1.7, 0.3, 0.7], MIDDLE).solid(&polygon, "")
    }),
    ("polycone-sizes", |size| {
        let keys = format!("scale = {:?}\nrotation = [0.3, -0.2, 0.5, 0.79]", [size; 3]);
        Step::seen(eye(25.0, 1.9).map(|x| size * x), [0.0; 3]).solid(&steps(0.0), &keys)
    }),
    ("edge-rays", |width| {
        let fov = 2.0 * (0.25 * width).atan().to_degrees();
        Step::through([2.0, 0.9, 1.3], [0.45, 0.0, 0.5], fov).solid(&steps(0.0), "")
    }),
    ("start-at-an-edge", |off| {
        Step::through([0.45 + off, 0.0, 0.5 + off], [0.2, 0.5, 0.51], 100.0).solid(&steps(0.0), "")
    }),
    ("out-and-in-again", |z| {
        // An eye in a tube's wall: the ray leaves it, crosses the hole and meets the wall again.
        let tube = sections(&[[0.1, 0.2, 0.4], [0.9, 0.25, 0.4]]);
        Step::through([0.3, 0.0, z], [-0.4, 0.1, 0.5], 80.0).solid(&tube, "")
    }),
    ("million-edge-rays", |segments| {
        let near = Step::through([1.2, 0.3, 0.7], [0.0, 0.0, 0.5], 20.0);
        let count = segments as usize;
        let points: Vec<_> = (0..=count).map(|k| on_half_turn(k, count, 0.4)).collect();
        near.solid(&points, "").sized(1152, 868)
    }),
];
