//! The projection of copies: rectangles of pixels.

use crate::plan::View;
use crate::scene::Placement;
use crate::shader::generated::{GROUP_PIXELS, QUAD_BITS};
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

impl Cylinder {
    /// One in the middle of the box.
    pub const fn centred(radius: f64, low: f64, high: f64) -> Self {
        Self {
            axis: DVec2::ZERO,
            radius,
            low,
            high,
        }
    }
}

/// The view as three linear maps. The first two over the third give a point's pixel, and the third
/// is its depth.
pub(crate) struct Projector {
    eye: DVec3,
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
    /// Margin of a rectangle on each side, in pixels: more than the roundings of 32 bits, and the
    /// largest distance of a pixel's rays from its centre.
    margin: f64,
}

/// Pixels: left, top, right, bottom, all inclusive.
pub(crate) type Rectangle = [u32; 4];

/// Pixels of a tile, and invocations of a work group.
pub(super) const TILE_PIXELS: u32 = GROUP_PIXELS * GROUP_PIXELS;
/// Most pixels along a side of the picture: tiles hold no more.
pub(crate) const MOST_PIXELS: u32 = 1 << QUAD_BITS;
/// Margin of a rectangle of pixels whose rays go through their centres.
const MARGIN: f64 = 1.0 / 16.0;

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
        Self {
            ends: [
                first_pixel(low.x).max(0),
                first_pixel(low.y).max(0),
                last_pixel(high.x).min(MOST_PIXELS as i32 - 1),
                last_pixel(high.y).min(MOST_PIXELS as i32 - 1),
            ],
            eye: view.eye,
            squares: rows.map(DVec3::length_squared).into(),
            products: DVec2::new(rows[0].dot(rows[2]), rows[1].dot(rows[2])),
            rows: DMat3::from_cols_array_2d(&rows.map(|r| r.to_array())).transpose(),
            low: low + 0.5,
            high: high - 0.5,
            margin: MARGIN + spread + slack,
        }
    }

    /// The pixels of the picture; none if no pixel is in the viewport.
    pub fn picture(&self) -> Option<Rectangle> {
        let [left, top, right, bottom] = self.ends;
        (left <= right && top <= bottom).then(|| self.ends.map(|pixel| pixel as u32))
    }

    /// The pixels of a copy's cylinder. Returns none if no pixel's ray can meet it.
    pub fn bounds(&self, copy: &Placement, of: &Cylinder) -> Option<Rectangle> {
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
            let turn = DMat3::from_quat(copy.rotation);
            let [x, y, z_way] = [
                turn.x_axis * copy.scale.x,
                turn.y_axis * copy.scale.y,
                turn.z_axis * copy.scale.z,
            ];
            let place = copy.position - self.eye + x * of.axis.x + y * of.axis.y;
            let [x, y] = [x, y].map(|way| self.rows * way * of.radius);
            (middle, z) = (self.rows * place, self.rows * z_way);
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
        self.pixels(low - self.margin, high + self.margin)
    }

    /// The pixels of a box in the world, of at least a point. Returns none if no pixel's ray can
    /// meet it.
    pub fn box_bounds(&self, [low, high]: [DVec3; 2]) -> Option<Rectangle> {
        let corners: [DVec3; 8] = std::array::from_fn(|n| {
            let end = |axis: usize| if n >> axis & 1 == 0 { low } else { high };
            self.rows * (DVec3::new(end(0).x, end(1).y, end(2).z) - self.eye)
        });
        let depths = corners.map(|corner| corner.z);
        let near = depths.into_iter().fold(f64::INFINITY, f64::min);
        let far = depths.into_iter().fold(f64::NEG_INFINITY, f64::max);
        if far <= 0.0 {
            return None;
        }
        let (mut low, mut high) = (DVec2::NEG_INFINITY, DVec2::INFINITY);
        if near > 1e-3 * far {
            let places = corners.map(|corner| corner.truncate() / corner.z);
            low = places.into_iter().fold(DVec2::INFINITY, DVec2::min);
            high = places.into_iter().fold(DVec2::NEG_INFINITY, DVec2::max);
        }
        self.pixels(low - self.margin, high + self.margin)
    }

    /// The pixels of the picture whose centres are in a rectangle, if any.
    fn pixels(&self, low: DVec2, high: DVec2) -> Option<Rectangle> {
        let [left, top, right, bottom] = self.ends;
        let [left, top] = [first_pixel(low.x).max(left), first_pixel(low.y).max(top)];
        let [right, bottom] = [
            last_pixel(high.x).min(right),
            last_pixel(high.y).min(bottom),
        ];
        let some = left <= right && top <= bottom;
        some.then(|| [left, top, right, bottom].map(|pixel| pixel as u32))
    }
}

/// The first pixel whose centre is not before a position.
///
/// Casts are faster than the library's rounding, which is a function call.
fn first_pixel(place: f64) -> i32 {
    let place = place - 0.5;
    let whole = place as i32;
    whole.saturating_add(i32::from(f64::from(whole) < place))
}

fn last_pixel(place: f64) -> i32 {
    let place = place - 0.5;
    let whole = place as i32;
    whole.saturating_sub(i32::from(f64::from(whole) > place))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::plan::DepthOrder;
    use crate::plan::Viewport;
    use glam::{DMat4, DVec4};

    /// A viewport may begin and end anywhere. Solids larger than it cover the pixels whose centres
    /// it holds, in front of the eye and around it.
    #[test]
    fn viewports_need_not_begin_at_the_first_pixel() {
        let shape = Cylinder::centred(50.0, -50.0, 50.0);
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
                let wanted = Some([left, top, right, bottom]);
                assert_eq!(projector.picture(), wanted, "{viewport:?}");
                for away in [0.0, 52.0] {
                    let position = DVec3::new(away, 0.0, 0.0);
                    let copy = Placement {
                        position,
                        ..Placement::default()
                    };
                    let one = projector.bounds(&copy, &shape);
                    let around = projector.box_bounds([position - 50.0, position + 50.0]);
                    assert_eq!(one, wanted, "{viewport:?}, {away}");
                    assert_eq!(around, wanted, "{viewport:?}, {away}");
                }
            }
        }
    }

    /// The box around a copy covers the pixels of the copy; what is behind the eye or far beside the
    /// picture covers none.
    #[test]
    fn boxes_cover_what_they_hold() {
        let camera = crate::scene::Camera::new(DVec3::new(-900.0, 3.0, 2.0), DVec3::ZERO);
        let view = View::from_camera(&camera, (64, 48), [1.0, 1e4]).unwrap();
        let projector = Projector::new(&view, 0.0, 0.0);
        let shape = Cylinder::centred(0.4, 0.0, 1.0);
        let mut seen = [0; 2];
        for n in 0..500 {
            let part = f64::from(n) / 500.0;
            let far = DVec3::new(0.0, 0.11 * f64::from(n) - 27.0, 0.07 * f64::from(n % 90));
            let position = far.lerp(view.eye() + DVec3::Y, part * part);
            let copy = Placement {
                position,
                ..Placement::default()
            };
            let half = DVec3::new(0.4, 0.4, 0.0);
            let around = projector.box_bounds([position - half, position + half + DVec3::Z]);
            let one = projector.bounds(&copy, &shape);
            seen[usize::from(one.is_some())] += 1;
            let Some([a, b, c, d]) = one else { continue };
            let [left, top, right, bottom] = around.unwrap();
            assert!(left <= a && top <= b && c <= right && d <= bottom, "{n}");
        }
        assert!(seen.iter().all(|count| *count > 20), "{seen:?}");
        for beside in [DVec3::new(-1000.0, 0.0, 0.0), DVec3::new(0.0, 90.0, 0.0)] {
            assert_eq!(
                projector.box_bounds([beside, beside + 1.0]),
                None,
                "{beside}"
            );
        }
    }
}
