//! The lines of a solid that are edges in a view: its silhouette, where the surface turns away from
//! the eye, and its rims.
//!
//! The points at which a quadric of revolution turns away are in one plane, the polar plane of the
//! eye. This gives the cosine of their azimuth at height `z`, relative to the eye's, in closed
//! form. The heights at which the cosine is 1 or -1 are the roots of a quadratic. If two patches
//! meet at an angle, the surface turns away along an arc of their common circle.

use glam::{DVec2, DVec3};
use revmap::scene::{CameraFrame, Placement};
use revmap::surface::QuadricPatch;
use std::f64::consts::PI;

/// A point of a line, on the screen.
#[derive(Clone, Copy, Debug)]
pub(super) struct Point {
    /// Pixels from the upper left corner.
    pub at: DVec2,
    /// Depth along the view.
    pub depth: f64,
    /// Largest depth difference to a pixel beside the line.
    pub reach: f64,
    /// True if the solid is beyond the line, which makes the line an edge; false if the solid is
    /// before it.
    pub bulges: bool,
    /// True for a line where the surface turns away, false for a rim.
    pub curved: bool,
}

/// Cosine of the least angle at which two patches meet in a rim that is smoothed although both are
/// visible.
const RIM: f64 = 0.94;
/// Pixels by which a line may pass beside the curve.
pub(super) const FLATNESS: f64 = 0.02;
/// Curves shorter than this many pixels are not subdivided at first.
const SHORT: f64 = 3.0;
/// Largest number of halvings of a curve.
const HALVINGS: u32 = 10;
/// Least distance of the eye from the axis, object units.
const OFF_AXIS: f64 = 1e-6;

/// A point of a curve and its position on the screen.
#[derive(Clone, Copy)]
struct Spot {
    /// Position on the surface, and the same relative to the eye, object units.
    place: DVec3,
    from_eye: DVec3,
    /// As in [`Point`].
    at: DVec2,
    depth: f64,
}

/// A curve on a solid, over 0 to 1; `None` behind the eye.
struct Curve<'a, F: Fn(f64) -> Option<Spot>> {
    sight: &'a Sight,
    /// The patches that contain the curve.
    patches: &'a [&'a QuadricPatch],
    /// As in [`Point`].
    curved: bool,
    at: F,
}

/// A copy of a solid in the eye's view, in object units about its axis.
pub(super) struct Sight {
    /// The eye.
    eye: DVec3,
    /// The eye's distance from the axis, and its direction from there.
    distance: f64,
    azimuth: DVec2,
    /// The depth of a point is the product of this with the vector from the eye to the point.
    forward: DVec3,
    /// The products with these are the point's position on the screen times its depth.
    right: DVec3,
    down: DVec3,
    middle: DVec2,
    /// Vectors to the next pixel at depth 1.
    step: [DVec3; 2],
    /// Largest difference of depths that is accepted.
    most: f64,
}

impl Sight {
    pub fn new(camera: &CameraFrame, placement: &Placement, axis: DVec2) -> Self {
        let back = placement.rotation.conjugate();
        let scale = placement.scale;
        let eye = (back * (camera.eye - placement.position)) / scale - axis.extend(0.0);
        let beside = eye.truncate();
        let distance = beside.length().max(OFF_AXIS);
        let row = |v: DVec3| (back * v) * scale;
        let step = |v: DVec3| (back * v) / scale;
        Self {
            eye,
            distance,
            azimuth: beside.try_normalize().unwrap_or(DVec2::X),
            forward: row(camera.forward),
            right: row(camera.right / camera.right.length_squared()),
            down: row(-camera.up / camera.up.length_squared()),
            middle: camera.middle.into(),
            step: [step(camera.right), step(camera.up)],
            most: 0.25 * scale.max_element(),
        }
    }

    /// A surface point at radius and height `p`, with the given cosine and sine of the azimuth.
    fn spot(&self, p: DVec2, [cos, sin]: [f64; 2]) -> Option<Spot> {
        let DVec2 { x: cx, y: cy } = self.azimuth;
        let beside = p.x * DVec2::new(cx * cos - cy * sin, cy * cos + cx * sin);
        let place = beside.extend(p.y);
        let from_eye = place - self.eye;
        let depth = from_eye.dot(self.forward);
        (depth > 1e-9).then(|| Spot {
            place,
            from_eye,
            at: DVec2::new(from_eye.dot(self.right), from_eye.dot(self.down)) / depth + self.middle,
            depth,
        })
    }

    /// Emits the lines of one level of the solid, as pairs of points.
    pub fn lines(&self, patches: &[QuadricPatch], emit: &mut impl FnMut(&Point, &Point)) {
        for patch in patches {
            self.turning(patch, emit);
        }
        for patch in patches {
            if let Some(next) = patch.next {
                self.rim(patch, &patches[next as usize], emit);
            }
        }
    }

    /// Emits the curve along which a patch turns away.
    fn turning(&self, patch: &QuadricPatch, emit: &mut impl FnMut(&Point, &Point)) {
        if patch.is_plane() {
            return;
        }
        let [a, k0, k1, k2] = patch.quadric;
        // a r distance cos = -(h0 + h1 z)
        let h0 = k0 + 0.5 * k1 * self.eye.z;
        let h1 = 0.5 * k1 + k2 * self.eye.z;
        let e2 = self.distance * self.distance;
        let quadratic = [
            h0 * h0 + a * e2 * k0,
            2.0 * h0 * h1 + a * e2 * k1,
            h1 * h1 + a * e2 * k2,
        ];
        let [low, high] = patch.z;
        let mut ends = vec![low];
        ends.extend(
            roots(quadratic)
                .into_iter()
                .filter(|z| *z > low && *z < high),
        );
        ends.push(high);
        for pair in ends.windows(2) {
            let [from, to] = [pair[0], pair[1]];
            let middle = 0.5 * (from + to);
            let [c0, c1, c2] = quadratic;
            if c0 + middle * (c1 + middle * c2) > 0.0 || to <= from {
                continue;
            }
            for side in [1.0, -1.0] {
                // The azimuth varies as the square root of the height close to the roots.
                let at = |s: f64| {
                    let z = from + (to - from) * 0.5 * (1.0 - (PI * s).cos());
                    let r = patch.square_at(z).max(0.0).sqrt();
                    let cos = (-(h0 + h1 * z) / (a * r * self.distance)).clamp(-1.0, 1.0);
                    let sin = side * (1.0 - cos * cos).max(0.0).sqrt();
                    if cos.is_nan() {
                        return None;
                    }
                    self.spot(DVec2::new(r, z), [cos, sin])
                };
                let curve = Curve {
                    sight: self,
                    patches: &[patch],
                    curved: true,
                    at,
                };
                curve.follow(emit);
            }
        }
    }

    /// Emits the circle in which two patches meet: the part where exactly one is visible if the
    /// solid is convex there, and the part where both are visible if they meet at an angle.
    fn rim(
        &self,
        before: &QuadricPatch,
        after: &QuadricPatch,
        emit: &mut impl FnMut(&Point, &Point),
    ) {
        let p = before.end;
        let normals = [before, after].map(|patch| patch.gradient(p).normalize_or_zero());
        let turn = normals[0].perp_dot(normals[1]);
        if p.x < 1e-9 || turn.abs() < 1e-12 {
            return;
        }
        let [mut s, mut t] = normals.map(|n| self.seen(p, n));
        if s[0] > t[0] || (s[0] == t[0] && s[1] > t[1]) {
            (s, t) = (t, s);
        }
        let both = [s[0].max(t[0]), s[1].min(t[1])];
        let sharp = normals[0].dot(normals[1]) < RIM;
        let arcs = match (turn > 0.0, sharp) {
            // Azimuths at which either patch is visible.
            (true, true) if both[0] < both[1] => [[s[0], s[1].max(t[1])], [0.0; 2]],
            (true, true) => [s, t],
            (true, false) if both[0] < both[1] => [[s[0], both[0]], [both[1], s[1].max(t[1])]],
            (true, false) => [s, t],
            (false, true) => [both, [0.0; 2]],
            (false, false) => return,
        };
        for [from, to] in arcs {
            if from >= to {
                continue;
            }
            for side in [1.0, -1.0] {
                let at = |part: f64| {
                    let (sin, cos) = (from + (to - from) * part).sin_cos();
                    self.spot(p, [cos, side * sin])
                };
                let curve = Curve {
                    sight: self,
                    patches: &[before, after],
                    curved: false,
                    at,
                };
                curve.follow(emit);
            }
        }
    }

    /// The azimuths, from 0 to pi off the eye's, at which a surface of this normal faces the eye.
    fn seen(&self, p: DVec2, normal: DVec2) -> [f64; 2] {
        let along = normal.y * (self.eye.z - p.y) - normal.x * p.x;
        let across = normal.x * self.distance;
        if across.abs() < 1e-12 {
            return [0.0, if along > 0.0 { PI } else { 0.0 }];
        }
        let turn = (-along / across).clamp(-1.0, 1.0).acos();
        if across > 0.0 {
            [0.0, turn]
        } else {
            [turn, PI]
        }
    }
}

impl<F: Fn(f64) -> Option<Spot>> Curve<'_, F> {
    /// Emits the curve as lines within the flatness tolerance.
    fn follow(&self, emit: &mut impl FnMut(&Point, &Point)) {
        let ends = [0.0, 0.5, 1.0].map(&self.at);
        let length = match &ends {
            [Some(a), Some(m), Some(b)] => a.at.distance(m.at) + m.at.distance(b.at),
            _ => f64::INFINITY,
        };
        // A longer curve may bend twice.
        let spots: &[_] = if length < SHORT {
            &[(0.0, ends[0]), (1.0, ends[2])]
        } else {
            &[
                (0.0, ends[0]),
                (0.25, (self.at)(0.25)),
                (0.5, ends[1]),
                (0.75, (self.at)(0.75)),
                (1.0, ends[2]),
            ]
        };
        let point = |(part, spot): &(f64, Option<Spot>)| Some((*part, self.point(spot.as_ref()?)));
        let mut last = None;
        for next in spots.iter().map(point) {
            if let (Some(a), Some(b)) = (&last, &next) {
                self.halve([a, b], HALVINGS, emit);
            }
            last = next;
        }
    }

    fn halve(&self, ends: [&(f64, Point); 2], left: u32, emit: &mut impl FnMut(&Point, &Point)) {
        let [(from, a), (to, b)] = ends;
        let way = b.at - a.at;
        let length = way.length();
        let middle = 0.5 * (from + to);
        if left > 0
            && length > 0.5
            && let Some(m) = (self.at)(middle)
            && (m.at - a.at).perp_dot(way).abs() > FLATNESS * length
        {
            let m = (middle, self.point(&m));
            self.halve([ends[0], &m], left - 1, emit);
            self.halve([&m, ends[1]], left - 1, emit);
        } else if a.bulges && b.bulges {
            emit(a, b);
        }
    }

    /// The depth difference accepted beside a spot, and the side on which the solid is.
    fn point(&self, spot: &Spot) -> Point {
        let Spot { place, depth, .. } = *spot;
        let ray = spot.from_eye / depth;
        let (mut reach, mut bulges) = (0.0f64, !self.curved);
        for patch in self.patches {
            // Along the ray about the point, G is `steep s + bend s^2`, minus its change from one
            // pixel to the next.
            let [a, _, k1, k2] = patch.quadric;
            let gradient = DVec3::new(
                2.0 * a * place.x,
                2.0 * a * place.y,
                k1 + 2.0 * k2 * place.z,
            );
            let steps = self.sight.step.iter();
            let change = depth * steps.map(|s| gradient.dot(*s).abs()).sum::<f64>();
            let bend = a * ray.truncate().length_squared() + k2 * ray.z * ray.z;
            let steep = gradient.dot(ray).abs();
            let root = (steep * steep + 4.0 * bend.max(0.0) * change).sqrt();
            let own = 2.0 * change / (steep + root);
            let most = self.sight.most;
            reach = reach.max(if own < most { own } else { most });
            bulges |= bend > 0.0;
        }
        Point {
            at: spot.at,
            depth,
            reach,
            bulges,
            curved: self.curved,
        }
    }
}

/// The real roots of `c0 + c1 x + c2 x^2`, in order.
fn roots([c0, c1, c2]: [f64; 3]) -> Vec<f64> {
    let square = c1 * c1 - 4.0 * c2 * c0;
    if square < 0.0 || square.is_nan() {
        return Vec::new();
    }
    let q = -0.5 * (c1 + square.sqrt().copysign(c1));
    let mut all: Vec<f64> = [q / c2, c0 / q]
        .into_iter()
        .filter(|x| x.is_finite())
        .collect();
    all.sort_unstable_by(f64::total_cmp);
    all
}
