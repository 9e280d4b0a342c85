//! Views along the axis, from within a tenth of a unit of it: tips, lids, hollows and holes through
//! narrow and wide lenses. In a quarter of the views the middle ray is the axis.

use super::numbers::{self, Random};
use super::{Draft, DraftCamera, DraftObject, OBLIQUE};
use glam::{DQuat, DVec3};
use std::f64::consts::TAU;

impl Draft {
    /// The view of a seed.
    pub(super) fn along_axis(seed: u64) -> Self {
        let r = &mut numbers::of(seed);
        let on_axis = r.once_in(4.0);
        let polygon = r.about_axis();
        let scale = r.maybe(2.0, 1.0, |r| r.log(0.01, 100.0));
        let sides = r.maybe(2.0, [1.0; 3], |r| [(); 3].map(|()| r.log(0.5, 2.0)));
        let sides = sides.map(|side| scale * side);
        let turn = r.maybe(2.0, [0.0, 0.0, 0.0, 1.0], Random::rotation);
        let turn = if on_axis { [0.0, 0.0, 0.0, 1.0] } else { turn };
        let at = r.maybe(2.0, [0.0; 3], |r| {
            let far = scale * r.log(0.1, 10.0);
            r.direction().map(|d| far * d)
        });

        // In the solid's own units.
        let heights = || polygon.iter().map(|p| p[1]);
        let ends = [
            heights().fold(f64::INFINITY, f64::min),
            heights().fold(f64::NEG_INFINITY, f64::max),
        ];
        let above = r.once_in(2.0);
        let [far_end, near_end] = if above { ends } else { [ends[1], ends[0]] };
        let away = r.log(0.3, 10.0) * if above { 1.0 } else { -1.0 };
        let mut aside = || {
            let (s, c) = r.between(0.0, TAU).sin_cos();
            let by = if on_axis { 0.0 } else { r.log(1e-3, 0.1) };
            [by * c, by * s]
        };
        let ([x, y], [u, v]) = (aside(), aside());
        let eye = [x, y, near_end + away];
        let tips = polygon.iter().filter(|p| p[0] == 0.0).map(|p| p[1]);
        let tips: Vec<f64> = if on_axis { Vec::new() } else { tips.collect() };
        let tip = tips.get((tips.len() as f64 * r.next()) as usize);
        // Towards the axis, at a corner if there is one, along it, or towards a point beside it.
        let target = match (3.0 * r.next()) as u32 {
            0 => [0.0, 0.0, *tip.unwrap_or(&far_end)],
            1 => [x, y, far_end],
            _ => [u, v, far_end],
        };
        let world = |p: [f64; 3]| {
            let p = DVec3::from(sides) * DVec3::from(p);
            (DVec3::from(at) + DQuat::from_array(turn) * p).to_array()
        };
        let camera = DraftCamera {
            eye: world(eye),
            target: world(target),
            fov: r.log(0.2, 60.0),
        };
        // With an odd number of pixels along both sides one ray is in the middle.
        let mut side = |least: f64, most: f64| r.between(least, most) as u32 | u32::from(on_axis);
        let size = (side(48.0, 97.0), side(36.0, 73.0));
        let up = r.maybe(2.0, OBLIQUE, |_| [0.0, 1.0, 0.0]);
        Self {
            seed,
            size,
            camera: camera.text(up),
            lines: Vec::new(),
            lights: vec![r.direction()],
            objects: vec![DraftObject {
                polygon,
                keys: vec![
                    format!("position = {at:?}"),
                    format!("scale = {sides:?}"),
                    format!("rotation = {turn:?}"),
                ],
                copies: Vec::new(),
            }],
        }
    }
}

impl Random {
    /// A polygon with something to see along its axis.
    fn about_axis(&mut self) -> Vec<[f64; 2]> {
        let (low, high) = (self.between(0.02, 0.3), self.between(0.7, 0.98));
        let outer = self.between(0.1, 0.48);
        let inner = outer * self.log(0.003, 0.7);
        // Heights of cones from nearly level to steep.
        let mut cone = |radius: f64| (radius * self.log(3e-3, 3.0)).min(0.19);
        let (first, second) = (cone(outer), cone(outer));
        let floor = 0.5 + cone(inner) * if self.once_in(2.0) { 1.0 } else { -1.0 };
        match (7.0 * self.next()) as u32 {
            // A tip below, a lid above.
            0 => vec![[0.0, low], [outer, low + first], [outer, high], [0.0, high]],
            // Two tips.
            1 => vec![
                [0.0, low],
                [outer, low + first],
                [outer, high - second],
                [0.0, high],
            ],
            // A hollow with a tip at its floor.
            2 => vec![
                [0.0, low],
                [outer, low],
                [outer, high],
                [inner, high],
                [inner, 0.5],
                [0.0, floor],
            ],
            // A hole that narrows or widens.
            3 => {
                let end = inner * self.between(0.5, 1.5);
                vec![[inner, low], [outer, low], [outer, high], [end, high]]
            }
            // A funnel above, a tip below.
            4 => vec![
                [0.0, low],
                [outer, low + first],
                [outer, high],
                [0.0, high - second],
            ],
            // A tip of several cones.
            5 => {
                let mut points = vec![[0.0, low]];
                for k in 1..=4 {
                    let climb = outer / 4.0 * self.log(3e-3, 1.0);
                    let z = points[k - 1][1] + climb * if self.once_in(4.0) { -0.2 } else { 1.0 };
                    points.push([outer * k as f64 / 4.0, z]);
                }
                points.extend([[outer, high], [0.0, high]]);
                points
            }
            _ => self.any_polygon(),
        }
    }
}
