//! A solid in its own box: extension, bevel, chamfer, the axis anywhere, replicas, closed by the
//! box.

use super::bracket::{Search, first_zero};
use super::field::Field;
use super::{Hit, Ray, Trace, is_ray};
use glam::{DVec2, DVec3};
use revmap::scene::{Growth, Object, Offset};
use std::sync::Arc;

/// The part of a solid's boundary that a ray hits.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Surface {
    /// The turned surface, `F = 0`.
    Turned,
    /// The cut at a face of the shape box, or at the border of a replica's cell, perpendicular to
    /// this axis (0 x, 1 y, 2 z).
    Cut(usize),
}

/// A solid of revolution, prepared for rays.
#[derive(Clone, Debug)]
pub(super) struct Solid {
    pub field: Arc<Field>,
    pub radius: f64,
    /// Enlargement of the box over the profile's.
    pub growth: Growth,
    pub offset: Offset,
    /// The position of the axis in a cell, object units.
    pub axis: DVec2,
    pub repeat: [u32; 3],
    pub mirror: [bool; 3],
}

/// Crossings this near to a face of the box (in units of the cell) count as the face itself.
const SKIN: f64 = 1e-10;
/// A ray grazes a box if its path inside is shorter than this, or if it misses the box by less.
const EDGE: f64 = 1e-7;
/// Sine of the angle between ray and surface below which a hit is grazing.
const FLAT: f64 = 1e-4;

impl Solid {
    pub fn new(object: &Object, field: Arc<Field>) -> Self {
        Self {
            field,
            radius: object.profile.radius,
            growth: Growth::of(object),
            offset: object.offset,
            axis: object.axis_offset().into(),
            repeat: object.repeat.map(|n| n.max(1)),
            mirror: object.mirror,
        }
    }

    /// The lowest and the highest corner of the box.
    pub fn faces(&self) -> [DVec3; 2] {
        let side = self.radius + self.growth.side;
        [
            DVec3::new(-side, -side, -self.growth.low),
            DVec3::new(side, side, 1.0 + self.growth.high),
        ]
    }

    /// The first hit at `t >= 0` of a ray in object space. The object and the instance of the hit
    /// are 0, and its normal is not of unit length.
    ///
    /// The boundary of the solid is where the ray's state (in or out) changes: within a cell at a
    /// zero of `F`, at a cell's border by the states of the two sides. All points outside the box
    /// are out.
    pub fn trace(&self, Ray { origin, direction }: Ray) -> Trace {
        let mut trace = Trace::default();
        // A ray's numbers may overflow in the space of a very large or very small solid.
        if !is_ray(origin, direction) {
            return trace;
        }
        let Some(clip) = Clip::new(self.faces(), origin, direction, &mut trace.grazes) else {
            return trace;
        };
        let start = origin + direction * clip.t[0];
        let mut solid_before = if clip.from_within { None } else { Some(false) };
        let cuts = self.cuts(start, direction, clip);
        for pair in cuts.windows(2) {
            let ((low, axis), (high, _)) = (pair[0], pair[1]);
            let cell = Cell::new(self, start, direction, 0.5 * (low + high));
            let skin = SKIN / cell.direction.length();
            let (a, b) = (low + skin, high - skin);
            if a >= b {
                continue;
            }
            let mut hint = 0;
            let mut count = 0;
            let mut f = |t: f64| {
                count += 1;
                cell.value(cell.at(t), &mut hint)
            };
            let fa = f(a);
            let solid = fa <= 0.0;
            if solid_before.is_some_and(|before| before != solid) {
                trace.evaluations += count;
                let side = if solid { -1.0 } else { 1.0 };
                trace.hit = Some(self.cut(start, direction, (low, clip.t[0]), axis, side));
                return trace;
            }
            let Search { zero, grazes } = first_zero(&mut f, a, b, fa, cell.lipschitz());
            trace.evaluations += count;
            trace.grazes |= grazes;
            if let Some(t) = zero {
                let normal = cell.normal(cell.at(t));
                trace.grazes |= normal.dot(cell.direction).abs()
                    < FLAT * normal.length() * cell.direction.length();
                let normal = normal * cell.factor;
                trace.hit = Some(cell.hit((t, clip.t[0]), normal, Surface::Turned));
                return trace;
            }
            solid_before = Some(solid);
        }
        if solid_before == Some(true) {
            let (t, axis) = cuts[cuts.len() - 1];
            trace.hit = Some(self.cut(start, direction, (t, clip.t[0]), axis, 1.0));
        }
        trace
    }

    /// The least value of `max(F, g)` for `t` from 0 to `last`, to within `tolerance`. `g` is the
    /// distance to the faces of box and cell. Values above `floor` count as `floor`, and the first
    /// below it ends the search.
    pub fn lowest(
        &self,
        Ray { origin, direction }: Ray,
        last: f64,
        tolerance: f64,
        floor: Option<f64>,
    ) -> f64 {
        let known = floor.unwrap_or(f64::INFINITY);
        if !is_ray(origin, direction) {
            return f64::INFINITY;
        }
        let speed = direction.length();
        let [low, high] = self.faces();
        let (middle, half) = (0.5 * (low + high), 0.5 * (high - low));
        let faces = |p: DVec3| ((p - middle).abs() - half).max_element();
        // The box only recedes beyond this point.
        let end = ((origin.distance(middle) + half.length()) / speed).min(last);
        let clip = Clip::new(self.faces(), origin, direction, &mut false);
        let Some(mut clip) = clip.filter(|clip| clip.t[0] <= last) else {
            return least(
                |t| faces(origin + direction * t),
                (0.0, end),
                speed,
                tolerance,
                (known, floor),
            );
        };
        clip.t[1] = clip.t[1].min(last);
        let start = origin + direction * clip.t[0];
        let mut lowest = known;
        for pair in self.cuts(start, direction, clip).windows(2) {
            let (low, high) = (pair[0].0, pair[1].0);
            let cell = Cell::new(self, start, direction, 0.5 * (low + high));
            let mut hint = 0;
            let value = |t: f64| {
                let p = cell.at(t);
                cell.value(p, &mut hint)
                    .max(faces(p + self.axis.extend(0.0)))
            };
            lowest = least(
                value,
                (low, high),
                cell.lipschitz(),
                tolerance,
                (lowest, floor),
            );
            if floor.is_some_and(|floor| lowest < floor) {
                break;
            }
        }
        lowest
    }

    /// The hit at the border of a cell; the outward normal points along the ray (`side` 1) or
    /// against it (-1).
    fn cut(
        &self,
        start: DVec3,
        direction: DVec3,
        (t, base): (f64, f64),
        axis: usize,
        side: f64,
    ) -> Hit {
        let mut normal = DVec3::ZERO;
        normal[axis] = side * direction[axis].signum();
        // The cell on the solid's side.
        let cell = Cell::new(self, start, direction, t - side * 1e-9 / direction.length());
        cell.hit((t, base), normal, Surface::Cut(axis))
    }

    /// The lowest coordinate of the profile's box along an axis, and its size.
    fn side(&self, axis: usize) -> (f64, f64) {
        if axis < 2 {
            (-self.radius, 2.0 * self.radius)
        } else {
            (0.0, 1.0)
        }
    }

    /// The points at which the ray passes from cell to cell, including the ends of the box:
    /// `(t from the start, axis of the plane)`, in order.
    fn cuts(&self, start: DVec3, direction: DVec3, clip: Clip) -> Vec<(f64, usize)> {
        let length = clip.t[1] - clip.t[0];
        let mut cuts = vec![(0.0, clip.axis[0])];
        for axis in 0..3 {
            let n = self.repeat[axis];
            let (low, size) = self.side(axis);
            cuts.extend((1..n).filter_map(|k| {
                let t = (low + size * f64::from(k) / f64::from(n) - start[axis]) / direction[axis];
                (t > 0.0 && t < length).then_some((t, axis))
            }));
        }
        cuts[1..].sort_by(|p, q| p.0.total_cmp(&q.0));
        cuts.push((length, clip.axis[1]));
        cuts
    }
}

/// The least value of `f` on an interval, or `lowest` if that is less. Each step is short enough,
/// for its value, to pass no lower value. The first value below `floor` ends the search.
fn least(
    mut f: impl FnMut(f64) -> f64,
    (mut t, end): (f64, f64),
    lipschitz: f64,
    tolerance: f64,
    (lowest, floor): (f64, Option<f64>),
) -> f64 {
    let mut lowest = lowest;
    loop {
        let value = f(t);
        lowest = lowest.min(value);
        if t >= end || floor.is_some_and(|floor| lowest < floor) {
            return lowest;
        }
        t = (t + (value - lowest + tolerance) / lipschitz).min(end);
    }
}

/// The part of a ray within the shape box.
#[derive(Clone, Copy, Debug)]
struct Clip {
    t: [f64; 2],
    /// Axes of the faces of entry and exit.
    axis: [usize; 2],
    from_within: bool,
}

impl Clip {
    fn new(
        [low, high]: [DVec3; 2],
        origin: DVec3,
        direction: DVec3,
        grazes: &mut bool,
    ) -> Option<Self> {
        let mut clip = Self {
            t: [f64::NEG_INFINITY, f64::INFINITY],
            axis: [0, 0],
            from_within: false,
        };
        let edge = EDGE / direction.length();
        for axis in 0..3 {
            if direction[axis] == 0.0 {
                let depth = (origin[axis] - low[axis]).min(high[axis] - origin[axis]);
                *grazes |= depth.abs() < EDGE;
                if depth < 0.0 {
                    return None;
                }
                continue;
            }
            let [a, b] = [low, high].map(|face| (face[axis] - origin[axis]) / direction[axis]);
            let t = [a.min(b), a.max(b)];
            if t[0] > clip.t[0] {
                (clip.t[0], clip.axis[0]) = (t[0], axis);
            }
            if t[1] < clip.t[1] {
                (clip.t[1], clip.axis[1]) = (t[1], axis);
            }
        }
        if clip.t[0] < 0.0 {
            clip.from_within = true;
            clip.t[0] = 0.0;
        }
        *grazes |= (clip.t[1] - clip.t[0]).abs() < edge;
        (clip.t[1] > clip.t[0]).then_some(clip)
    }
}

/// A replica's own space: the shape box, moved so that the axis of revolution is x = y = 0.
struct Cell<'a> {
    solid: &'a Solid,
    /// The ray's start and direction.
    origin: DVec3,
    direction: DVec3,
    /// Cell units per object unit, along each axis; negative for a mirrored replica.
    factor: DVec3,
}

impl<'a> Cell<'a> {
    /// The cell that contains the point of the ray from `start` (object space) at `t`.
    fn new(solid: &'a Solid, start: DVec3, direction: DVec3, t: f64) -> Self {
        let mut factor = DVec3::ZERO;
        let mut origin = DVec3::ZERO;
        for axis in 0..3 {
            let n = f64::from(solid.repeat[axis]);
            let (low, size) = solid.side(axis);
            let place = |x: f64| (x - low) / size * n;
            let index = place(start[axis] + direction[axis] * t)
                .floor()
                .clamp(0.0, n - 1.0);
            let mirrored = solid.mirror[axis] && index % 2.0 == 1.0;
            let fraction = place(start[axis]) - index;
            factor[axis] = if mirrored { -n } else { n };
            origin[axis] = low + size * if mirrored { 1.0 - fraction } else { fraction };
        }
        origin -= solid.axis.extend(0.0);
        Self {
            solid,
            origin,
            direction: direction * factor,
            factor,
        }
    }

    /// The hit at `t` after the ray's start in the box, which is at `base`.
    fn hit(&self, (t, base): (f64, f64), normal: DVec3, surface: Surface) -> Hit {
        Hit {
            t: base + t,
            object: 0,
            instance: 0,
            normal,
            surface,
            place: self.at(t),
            cell: self.factor,
        }
    }

    fn at(&self, t: f64) -> DVec3 {
        self.origin + self.direction * t
    }

    /// `F = d - w` (method: section 3).
    fn value(&self, p: DVec3, hint: &mut u32) -> f64 {
        let offset = &self.solid.offset;
        let w = offset.extend + offset.bevel * (1.0 - p.z).min(offset.chamfer);
        self.solid
            .field
            .distance(DVec2::new(p.x.hypot(p.y), p.z), hint)
            - w
    }

    /// Lipschitz constant of `F` along the ray: `d` changes by the length of the path, `w` by its
    /// slope times the climb.
    fn lipschitz(&self) -> f64 {
        self.direction.length() + (self.solid.offset.bevel * self.direction.z).abs()
    }

    /// Gradient of `F`; it points outward.
    fn normal(&self, p: DVec3) -> DVec3 {
        let r = p.x.hypot(p.y);
        let q = DVec2::new(r, p.z);
        let field = &self.solid.field;
        let g = field.gradient(q, field.nearest(q, 0));
        let offset = &self.solid.offset;
        let slope = if 1.0 - p.z < offset.chamfer {
            -offset.bevel
        } else {
            0.0
        };
        let radial = if r > 1e-12 { g.x / r } else { 0.0 };
        DVec3::new(p.x * radial, p.y * radial, g.y - slope)
    }
}
