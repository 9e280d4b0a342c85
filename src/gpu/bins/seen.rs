//! A copy as the view sees it: its rectangle of pixels and its nearest depth.

use super::cover::{first_pixel, last_pixel};
use crate::gpu::view::View;
use crate::scene::Placement;
use glam::{DMat3, DVec2, DVec3};

/// What of a box can be solid: a cylinder about the axis, object units from the middle of the
/// box's lower face.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Cylinder {
    pub axis: DVec2,
    pub radius: f64,
    pub low: f64,
    pub high: f64,
}

/// The view as three linear forms: a point's pixel is the first two over the third, its depth.
pub(crate) struct Forms {
    pub(super) eye: DVec3,
    pub(super) rows: DMat3,
    /// First and last pixel centre, both axes.
    pub(super) low: DVec2,
    pub(super) high: DVec2,
    /// A pixel's longer side at unit depth.
    pixel: f64,
}

/// Ways along an object's axes, one object unit each, and the place of its axis at `z = 0`; as
/// forms have them, and in the world.
pub(crate) struct Spread {
    pub middle: DVec3,
    pub along: [DVec3; 3],
    /// The eye in object space, about the axis.
    pub eye: DVec3,
    /// World units of the shortest object unit.
    least_scale: f64,
}

/// What a copy covers.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Seen {
    /// Left, top, right, bottom: pixels, all included.
    pub pixels: [u16; 4],
    /// No point of the copy is nearer.
    pub near: f32,
}

/// By how much a rectangle is wider than computed, pixels: more than roundings of 32 bits amount
/// to.
pub(super) const MARGIN: f64 = 1.0 / 16.0;
/// By how much depths are moved to the safe side, as a part.
pub(super) const SLACK: f64 = 1e-5;

impl Forms {
    /// Of a view of perspective.
    pub fn new(view: &View) -> Self {
        let row = |d: DVec3| {
            let d = d / d.length_squared();
            d + view.forward * (0.5 - view.dir_00.dot(d))
        };
        let rows = [row(view.dir_x), row(view.dir_y), view.forward];
        let [low, high] = view.corners();
        Self {
            eye: view.eye,
            rows: DMat3::from_cols_array_2d(&rows.map(|r| r.to_array())).transpose(),
            low: low + 0.5,
            high: high - 0.5,
            pixel: view.dir_x.length().max(view.dir_y.length()),
        }
    }

    /// First and last pixel of both axes: left, top, right, bottom.
    pub fn picture(&self) -> [u32; 4] {
        let first = (self.low - 0.5).ceil();
        let last = (self.high - 0.5).floor();
        [first.x, first.y, last.x, last.y].map(|pixel| pixel.max(0.0) as u32)
    }

    pub fn spread(&self, copy: &Placement, axis: DVec2) -> Spread {
        let turn = DMat3::from_quat(copy.rotation);
        let from_eye = copy.position - self.eye;
        let shift = axis * copy.scale.truncate();
        let place = from_eye + turn.x_axis * shift.x + turn.y_axis * shift.y;
        let ways = [
            turn.x_axis * copy.scale.x,
            turn.y_axis * copy.scale.y,
            turn.z_axis * copy.scale.z,
        ];
        Spread {
            middle: self.rows * place,
            along: ways.map(|way| self.rows * way),
            eye: -(turn.transpose() * place) / copy.scale,
            least_scale: copy.scale.min_element(),
        }
    }

    /// Object units that are seen as [`MARGIN`] or more all over a cylinder.
    pub fn margin(&self, spread: &Spread, of: &Cylinder) -> f64 {
        let [x, y, z] = spread.along.map(|way| way.z);
        let deep = of.radius * (x.abs() + y.abs()) + (z * of.low).max(z * of.high);
        MARGIN * self.pixel * (spread.middle.z + deep) / spread.least_scale
    }

    /// None where no pixel's ray can meet the cylinder.
    pub fn see(&self, spread: &Spread, of: &Cylinder) -> Option<Seen> {
        let [x, y, z] = spread.along;
        let square = |i: usize, k: usize| of.radius * of.radius * (x[i] * x[k] + y[i] * y[k]);
        let discs = [of.low, of.high].map(|h| spread.middle + z * h);
        let deep = square(2, 2).sqrt();
        let near = discs[0].z.min(discs[1].z) - deep;
        let far = discs[0].z.max(discs[1].z) + deep;
        if far <= 0.0 {
            return None;
        }
        let mut pixels = [0u16; 4];
        for i in 0..2 {
            let (mut low, mut high) = (f64::INFINITY, f64::NEG_INFINITY);
            if near > 1e-3 * far {
                // Lines of sight that touch a disc: the roots of a quadratic.
                for c in &discs {
                    let a = c.z * c.z - square(2, 2);
                    let b = c[i] * c.z - square(i, 2);
                    let root = (b * b - a * (c[i] * c[i] - square(i, i))).max(0.0).sqrt();
                    let inverse = 1.0 / a;
                    low = low.min((b - root) * inverse);
                    high = high.max((b + root) * inverse);
                }
            } else {
                // Around or beside the eye: everything, unless it lies beyond an edge of the
                // picture.
                (low, high) = (self.low[i], self.high[i]);
                let beyond = |edge: f64, sense: f64| {
                    let side = |c: &DVec3| sense * (c[i] - edge * c.z);
                    let wide =
                        square(i, i) - 2.0 * edge * square(i, 2) + edge * edge * square(2, 2);
                    side(&discs[0]).max(side(&discs[1])) + wide.max(0.0).sqrt() < 0.0
                };
                if beyond(self.low[i] - MARGIN, 1.0) || beyond(self.high[i] + MARGIN, -1.0) {
                    return None;
                }
            }
            let ends = [self.low[i], self.high[i]].map(|middle| (middle - 0.5) as i32);
            let first = first_pixel(low.max(self.low[i]) - MARGIN).max(ends[0]);
            let last = last_pixel(high.min(self.high[i]) + MARGIN).min(ends[1]);
            if first > last {
                return None;
            }
            (pixels[i], pixels[i + 2]) = (first as u16, last as u16);
        }
        Some(Seen {
            pixels,
            near: (near * (1.0 - SLACK)).max(0.0) as f32,
        })
    }
}
