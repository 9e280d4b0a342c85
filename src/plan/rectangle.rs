//! The pixels that a box may touch, as a rectangle.

use crate::plan::View;
use crate::scene::Placement;
use glam::{DVec2, DVec3};

/// A rectangle of bins or work groups, both ends included.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Rectangle {
    pub low: (u32, u32),
    pub high: (u32, u32),
}

impl Rectangle {
    /// Number of squares.
    pub fn squares(self) -> u64 {
        u64::from(self.high.0 - self.low.0 + 1) * u64::from(self.high.1 - self.low.1 + 1)
    }
}

/// The squares of `unit` pixels that a box may touch. Returns none if the box is behind the eye or
/// outside of the picture.
pub(crate) fn rectangle(
    view: &View,
    unit: u32,
    radius: f64,
    placement: &Placement,
) -> Option<Rectangle> {
    // Pixel and depth are linear except for one division. The linear part is computed for the
    // middle and for half of each side, not for each corner.
    let rows = [view.dir_x, view.dir_y].map(|d| d / d.length_squared());
    let from = rows.map(|row| {
        0.5 - if view.parallel {
            0.0
        } else {
            row.dot(view.dir_00)
        }
    });
    let rows = [rows[0], rows[1], view.forward];
    let Placement {
        position,
        rotation,
        scale,
    } = *placement;
    let up = rotation * DVec3::new(0.0, 0.0, 0.5 * scale.z);
    let sides = [
        rotation * DVec3::new(radius * scale.x, 0.0, 0.0),
        rotation * DVec3::new(0.0, radius * scale.y, 0.0),
        up,
    ]
    .map(|side| rows.map(|row| row.dot(side)));
    let middle = rows.map(|row| row.dot(position + up - view.eye));
    let mut low = DVec2::INFINITY;
    let mut high = DVec2::NEG_INFINITY;
    let mut nearest = f64::INFINITY;
    let mut farthest = f64::NEG_INFINITY;
    for corner in 0..8 {
        let sign = |bit: u32| if corner & (1 << bit) == 0 { -1.0 } else { 1.0 };
        let along = |k: usize| {
            let ways = (0u32..).zip(&sides);
            ways.fold(middle[k], |sum, (bit, side)| sum + sign(bit) * side[k])
        };
        let depth = along(2);
        let over = if view.parallel { 1.0 } else { depth };
        let pixel = DVec2::new(along(0) / over + from[0], along(1) / over + from[1]);
        nearest = nearest.min(depth);
        farthest = farthest.max(depth);
        low = low.min(pixel);
        high = high.max(pixel);
    }
    if farthest <= 0.0 {
        return None;
    }
    let [corner, full] = view.corners();
    if nearest <= 1e-9 * farthest {
        // A box around the eye, or beside it, has no rectangular projection.
        (low, high) = (corner, full);
    }
    low = (low - 1.0).max(corner);
    high = (high + 1.0).min(full - 1.0);
    if low.x > high.x || low.y > high.y || !(low.is_finite() && high.is_finite()) {
        return None;
    }
    let bin = |v: f64| (v / f64::from(unit)) as u32;
    Some(Rectangle {
        low: (bin(low.x), bin(low.y)),
        high: (bin(high.x), bin(high.y)),
    })
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use crate::scene::Camera;
    use glam::DQuat;

    #[test]
    fn a_rectangle_holds_the_corners_of_its_box() {
        let camera = Camera::new(DVec3::new(3.0, 1.0, 2.0), DVec3::new(0.0, 0.0, 0.4));
        let view = View::from_camera(&camera, (640, 480), [0.1, 100.0]).unwrap();
        for turn in 0..20 {
            let turn = f64::from(turn);
            let copy = Placement {
                position: DVec3::new(0.05 * turn - 0.5, 0.3, -0.2),
                rotation: DQuat::from_rotation_y(0.3 * turn) * DQuat::from_rotation_x(turn),
                scale: DVec3::new(0.5, 0.7, 0.4 + 0.02 * turn),
            };
            let found = rectangle(&view, 1, 0.6, &copy).unwrap();
            let corners = (0..8).map(|k| {
                let side = |bit: u32, low: f64| if k & bit == 0 { low } else { 0.6 };
                let p = DVec3::new(
                    side(1, -0.6),
                    side(2, -0.6),
                    f64::from(u8::from(k & 4 != 0)),
                );
                view.project(copy.position + copy.rotation * (copy.scale * p))
                    .0
            });
            let (low, high) = corners.fold((DVec2::INFINITY, DVec2::NEG_INFINITY), |(a, b), p| {
                (a.min(p), b.max(p))
            });
            let grown = [low.x - 1.0, low.y - 1.0, high.x + 1.0, high.y + 1.0];
            let kept = grown.map(|v| v.max(0.0) as u32);
            assert_eq!([kept[0], kept[1]], [found.low.0, found.low.1]);
            assert_eq!(
                [kept[2].min(639), kept[3].min(479)],
                [found.high.0, found.high.1]
            );
        }
    }
}
