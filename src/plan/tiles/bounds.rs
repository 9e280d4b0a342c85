//! The projection of one copy, or of a cluster of copies: the rectangle of pixels and the nearest
//! depth.

use crate::plan::View;
use crate::scene::{Cluster, Placement};
use crate::shader::generated::QUAD_BITS;
use glam::{DMat3, DVec2, DVec3};

/// The part of a box that can be solid: a cylinder about the axis. Object units, from the middle of
/// the box's lower face.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Cylinder {
    pub axis: DVec2,
    pub radius: f64,
    pub low: f64,
    pub high: f64,
}

/// The view as three linear maps. The first two over the third give a point's pixel, and the third
/// is its depth.
pub(crate) struct Projector {
    eye: DVec3,
    /// Depth at which rays begin.
    pub(super) start: f64,
    /// The largest distance from the eye at which a ray begins.
    farthest_start: f64,
    rows: DMat3,
    /// Products of each map with itself, and of the first two with the third.
    squares: DVec3,
    products: DVec2,
    /// First and last pixel centre, both axes.
    low: DVec2,
    high: DVec2,
    /// First and last pixel of both axes whose centres are in the viewport: left, top, right,
    /// bottom. The last one is before the first one if there are none.
    ends: [i32; 4],
    /// A pixel's longer side at unit depth.
    pixel: f64,
    /// Margin of a rectangle on each side, in pixels: more than the roundings of 32 bits, and the
    /// largest distance of a pixel's rays from its centre.
    pub(super) margin: f64,
    /// Relative margin of nearest depths.
    depth_slack: f64,
}

/// Steps of one object unit along an object's axes, and the position of its axis at `z = 0`, both
/// under the three linear maps. The eye and the scale are in object and world units.
pub(crate) struct ProjectedAxes {
    pub middle: DVec3,
    pub along: [DVec3; 3],
    /// The eye in object space, about the axis.
    pub eye: DVec3,
    /// World units in the shortest object unit.
    least_scale: f64,
}

/// The pixels and depth of a copy.
#[derive(Clone, Copy, Debug)]
pub(crate) struct ScreenBounds {
    /// Left, top, right, bottom: pixels, all inclusive.
    pub pixels: [u16; 4],
    /// No point of the copy is nearer.
    pub near: f32,
}

/// Most pixels along a side of the picture: tiles and quads hold no more.
pub(crate) const MOST_PIXELS: u32 = 1 << QUAD_BITS;
/// Pixels along the side of a tile.
pub(super) const SIDE: u32 = 8;
/// Margin of a rectangle of pixels whose rays go through their centres.
const MARGIN: f64 = 1.0 / 16.0;
/// Relative margin of depths, towards the safe side.
pub(super) const SLACK: f64 = 1e-5;

impl Projector {
    /// Makes the projector of a perspective view. `spread`: largest distance of a ray from its
    /// pixel's centre, pixels. `slack`: largest distance of a copy's surface from the one whose
    /// bounds are projected, pixels.
    pub fn new(view: &View, spread: f64, slack: f64) -> Self {
        let row = |d: DVec3| {
            let d = d / d.length_squared();
            d + view.forward * (0.5 - view.dir_00.dot(d))
        };
        let rows = [row(view.dir_x), row(view.dir_y), view.forward];
        let [mut low, mut high] = view.corners();
        if let Some([first, end]) = view.rows.map(|rows| rows.map(f64::from)) {
            (low.y, high.y) = (low.y.max(first), high.y.min(end));
        }
        let pixel = view.dir_x.length().max(view.dir_y.length());
        Self {
            ends: [
                first_pixel(low.x).max(0),
                first_pixel(low.y).max(0),
                last_pixel(high.x).min(MOST_PIXELS as i32 - 1),
                last_pixel(high.y).min(MOST_PIXELS as i32 - 1),
            ],
            eye: view.eye,
            start: view.start,
            farthest_start: view.farthest_start(),
            squares: rows.map(DVec3::length_squared).into(),
            products: DVec2::new(rows[0].dot(rows[2]), rows[1].dot(rows[2])),
            rows: DMat3::from_cols_array_2d(&rows.map(|r| r.to_array())).transpose(),
            low: low + 0.5,
            high: high - 0.5,
            pixel,
            margin: MARGIN + spread + slack,
            depth_slack: SLACK + slack * pixel,
        }
    }

    /// The pixels of the picture: left, top, right, bottom.
    pub fn picture(&self) -> [u32; 4] {
        self.ends.map(|pixel| pixel.max(0) as u32)
    }

    /// Number of tiles across and down; none if no pixel is in the viewport.
    pub fn tiles(&self) -> [u32; 2] {
        let [left, top, right, bottom] = self.ends;
        if left > right || top > bottom {
            return [0; 2];
        }
        [right, bottom].map(|last| last as u32 / SIDE + 1)
    }

    pub fn axes(&self, copy: &Placement, axis: DVec2) -> ProjectedAxes {
        let turn = DMat3::from_quat(copy.rotation);
        let from_eye = copy.position - self.eye;
        let shift = axis * copy.scale.truncate();
        let place = from_eye + turn.x_axis * shift.x + turn.y_axis * shift.y;
        let ways = [
            turn.x_axis * copy.scale.x,
            turn.y_axis * copy.scale.y,
            turn.z_axis * copy.scale.z,
        ];
        ProjectedAxes {
            middle: self.rows * place,
            along: ways.map(|way| self.rows * way),
            eye: -(turn.transpose() * place) / copy.scale,
            least_scale: copy.scale.min_element(),
        }
    }

    /// The largest distance from the eye at which a ray begins, object units.
    pub fn reach(&self, axes: &ProjectedAxes) -> f64 {
        self.farthest_start / axes.least_scale
    }

    /// A length in object units that covers at least the margin everywhere on a cylinder.
    pub fn margin(&self, axes: &ProjectedAxes, of: &Cylinder) -> f64 {
        let [x, y, z] = axes.along.map(|way| way.z);
        let deep = of.radius * (x.abs() + y.abs()) + (z * of.low).max(z * of.high);
        self.margin * self.pixel * (axes.middle.z + deep) / axes.least_scale
    }

    /// The bounds of a copy's cylinder. Returns none if no pixel's ray can meet it.
    pub fn bounds(&self, copy: &Placement, of: &Cylinder) -> Option<ScreenBounds> {
        // Products of the maps over a disc: of each with itself, and of the first two with depth.
        let (middle, z, squares, products);
        if copy.scale.x == copy.scale.y && of.axis == DVec2::ZERO {
            // A disc at right angles to its axis, however it is turned about it.
            let axis = DMat3::from_quat(copy.rotation).z_axis;
            let way = self.rows * axis;
            let away = way / axis.length_squared();
            let square = (of.radius * copy.scale.x).powi(2);
            middle = self.rows * (copy.position - self.eye);
            z = way * copy.scale.z;
            squares = (self.squares - way * away) * square;
            products = (self.products - way.truncate() * away.z) * square;
        } else {
            let axes = self.axes(copy, of.axis);
            let [x, y] = [0, 1].map(|k| axes.along[k] * of.radius);
            (middle, z) = (axes.middle, axes.along[2]);
            squares = x * x + y * y;
            products = x.truncate() * x.z + y.truncate() * y.z;
        }
        let discs = [of.low, of.high].map(|h| middle + z * h);
        let deep = squares.z.max(0.0).sqrt();
        let near = discs[0].z.min(discs[1].z) - deep;
        let far = discs[0].z.max(discs[1].z) + deep;
        if far <= 0.0 {
            return None;
        }
        let (mut low, mut high) = (DVec2::INFINITY, DVec2::NEG_INFINITY);
        if near > 1e-3 * far {
            // Lines of sight that are tangent to a disc: the roots of a quadratic.
            for c in discs {
                let flat = c.truncate();
                let a = c.z * c.z - squares.z;
                let b = flat * c.z - products;
                let root = (b * b - a * (flat * flat - squares.truncate())).max(DVec2::ZERO);
                let root = DVec2::new(root.x.sqrt(), root.y.sqrt());
                let inverse = 1.0 / a;
                low = low.min((b - root) * inverse);
                high = high.max((b + root) * inverse);
            }
        } else {
            // A cylinder around the eye, or beside it, covers everything unless it is beyond an
            // edge of the picture.
            let beyond = |i: usize, edge: f64, sense: f64| {
                let side = |c: &DVec3| sense * (c[i] - edge * c.z);
                let wide = squares[i] - 2.0 * edge * products[i] + edge * edge * squares.z;
                side(&discs[0]).max(side(&discs[1])) + wide.max(0.0).sqrt() < 0.0
            };
            let ends = [self.low - self.margin, self.high + self.margin];
            if (0..2).any(|i| beyond(i, ends[0][i], 1.0) || beyond(i, ends[1][i], -1.0)) {
                return None;
            }
            (low, high) = (DVec2::NEG_INFINITY, DVec2::INFINITY);
        }
        Some(ScreenBounds {
            pixels: self.pixels(low - self.margin, high + self.margin)?,
            near: (near * (1.0 - self.depth_slack)).max(0.0) as f32,
        })
    }

    /// The pixels of the picture whose centres are in a rectangle, if any.
    fn pixels(&self, low: DVec2, high: DVec2) -> Option<[u16; 4]> {
        let [left, top, right, bottom] = self.ends;
        let [left, top] = [first_pixel(low.x).max(left), first_pixel(low.y).max(top)];
        let [right, bottom] = [
            last_pixel(high.x).min(right),
            last_pixel(high.y).min(bottom),
        ];
        let some = left <= right && top <= bottom;
        some.then(|| [left, top, right, bottom].map(|pixel| pixel as u16))
    }

    /// A rectangle that contains the rectangles of all copies, and a lower bound of their depths.
    /// Returns none if no ray can meet a copy, or if no copy's rectangle contains a pixel's centre.
    pub fn cluster_bounds(&self, cluster: &Cluster, of: &Cylinder) -> Option<ScreenBounds> {
        let beside = of.axis.length() + of.radius;
        let around = cluster.around(self.eye, [beside, of.low.abs().max(of.high.abs())]);
        let depth = self.rows.row(2);
        let [near, far] = around.along(depth);
        if far <= 0.0 {
            return None;
        }
        let (mut low, mut high) = (DVec2::NEG_INFINITY, DVec2::INFINITY);
        for i in 0..2 {
            let row = self.rows.row(i);
            let [first, last] = [self.low[i] - self.margin, self.high[i] + self.margin];
            if near > 1e-3 * far {
                // The projected middle, and the largest distance of any copy from it.
                let at = around.middle.dot(row) / around.middle.dot(depth);
                let off = around.along(row - depth * at)[1] / near + 2.0 * self.margin;
                (low[i], high[i]) = (at - off, at + off);
            } else if around.along(row - depth * first)[1] < 0.0
                || around.along(row - depth * last)[0] > 0.0
            {
                return None;
            }
        }
        Some(ScreenBounds {
            pixels: self.pixels(low, high)?,
            near: (near * (1.0 - 2.0 * self.depth_slack)).max(0.0) as f32,
        })
    }
}

/// The first pixel whose centre is not before a position.
///
/// Casts are faster than the library's rounding, which is a function call.
pub(super) fn first_pixel(place: f64) -> i32 {
    let place = place - 0.5;
    let whole = place as i32;
    whole.saturating_add(i32::from(f64::from(whole) < place))
}

/// The last pixel whose centre is not after a position.
pub(super) fn last_pixel(place: f64) -> i32 {
    let place = place - 0.5;
    let whole = place as i32;
    whole.saturating_sub(i32::from(f64::from(whole) > place))
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use crate::plan::DepthOrder;
    use crate::plan::Viewport;
    use crate::scene::Copies;
    use glam::{DMat4, DVec4};

    /// Two copies at one place.
    fn pair(position: DVec3) -> Copies {
        let copy = Placement {
            position,
            ..Placement::default()
        };
        vec![copy; 2].into()
    }

    /// A viewport may begin and end anywhere. Copies larger than it cover the pixels whose centres
    /// it holds. A cluster of such copies covers the same pixels, in front of the eye and around
    /// it.
    #[test]
    fn viewports_need_not_begin_at_the_first_pixel() {
        let shape = Cylinder {
            axis: DVec2::ZERO,
            radius: 50.0,
            low: -50.0,
            high: 50.0,
        };
        let eye = DVec3::new(0.0, 0.0, 0.5);
        for [x, y] in [
            [0.0, 0.0],
            [-4.0, -3.0],
            [5.0, 3.0],
            [0.03, 7.6],
            [-0.5, 2.5],
        ] {
            for [width, height] in [[64.0, 48.0], [40.6, 33.3]] {
                let viewport = Viewport {
                    x,
                    y,
                    width,
                    height,
                };
                let look = DMat4::from_translation(-eye);
                // The view is along x with z upwards; depth is from 0.1 to 1000.
                let deep = 1000.0 / 999.9;
                let lens = DMat4::from_rows(
                    DVec4::new(0.0, -1.0, 0.0, 0.0),
                    DVec4::new(0.0, 0.0, -width / height, 0.0),
                    DVec4::new(deep, 0.0, 0.0, -0.1 * deep),
                    DVec4::X,
                );
                let view = View::from_matrices(look, lens, viewport, DepthOrder::Normal).unwrap();
                let projector = Projector::new(&view, 0.0, 0.0);
                let ends = |from: f64, size: f64| {
                    let inside = |k: &i32| (from..=from + size).contains(&(f64::from(*k) + 0.5));
                    let all: Vec<u32> = (0..200).filter(inside).map(|k| k as u32).collect();
                    [all[0], all[all.len() - 1]]
                };
                let ([left, right], [top, bottom]) = (ends(x, width), ends(y, height));
                let wanted = [left, top, right, bottom];
                assert_eq!(projector.picture(), wanted, "{viewport:?}");
                for away in [0.0, 52.0] {
                    let position = DVec3::new(away, 0.0, 0.0);
                    let copies = pair(position);
                    let one = projector.bounds(&copies[0], &shape).unwrap();
                    let cluster = &copies.clusters().all()[0];
                    let all = projector.cluster_bounds(cluster, &shape).unwrap();
                    assert_eq!(one.pixels.map(u32::from), wanted, "{viewport:?}, {away}");
                    assert_eq!(all.pixels, one.pixels, "{viewport:?}, {away}");
                }
            }
        }
    }

    /// A far cluster between the centres of two pixels has no bounds.
    #[test]
    fn clusters_below_a_pixel_have_sound_rectangles() {
        let camera = crate::scene::Camera::new(DVec3::new(-900.0, 3.0, 2.0), DVec3::ZERO);
        let view = View::from_camera(&camera, (64, 48), [1.0, 1e4]).unwrap();
        let projector = Projector::new(&view, 0.0, 0.0);
        let shape = Cylinder {
            axis: DVec2::ZERO,
            radius: 0.4,
            low: 0.0,
            high: 1.0,
        };
        let mut seen = [0; 2];
        for n in 0..500 {
            let position = DVec3::new(0.0, 0.11 * f64::from(n) - 27.0, 0.07 * f64::from(n % 90));
            let copies = pair(position);
            let all = projector.cluster_bounds(&copies.clusters().all()[0], &shape);
            let one = projector.bounds(&copies[0], &shape);
            seen[usize::from(all.is_some())] += 1;
            let Some(ScreenBounds {
                pixels: [x0, y0, x1, y1],
                near,
            }) = all
            else {
                assert!(one.is_none(), "{n}");
                continue;
            };
            assert!(x0 <= x1 && y0 <= y1, "{n}");
            assert!(one.is_none_or(|one| {
                let [a, b, c, d] = one.pixels;
                x0 <= a && y0 <= b && c <= x1 && d <= y1 && near <= one.near
            }));
        }
        assert!(seen.iter().all(|count| *count > 20), "{seen:?}");
    }
}
