//! Rays against solids on the CPU, in double precision: for picking and physics.
//!
//! A [`RayCaster`] holds the patches of an object's surface under its offset, in rows of equal
//! height. It finds the hit that a drawing of tolerance 0 shows: the patches of the exact level,
//! boxes, replicas and copies, without bumps. [`QuadricPatch`] has the equations; patches follow
//! the outline within [`FitOptions::tolerance`].
//!
//! ```
//! use glam::DVec3;
//! use revmap::{cast::RayCaster, profile::Profile, scene::Object};
//! let corners = [[0.0, 0.0], [0.5, 0.0], [0.5, 1.0], [0.0, 1.0]];
//! let cylinder = Object::new("cylinder", Profile::polygon(&corners, 0.5)?.into());
//! let hit = RayCaster::new(&cylinder)?.cast(DVec3::new(2.0, 0.0, 0.5), -DVec3::X);
//! assert!((hit.unwrap().t - 1.5).abs() < 1e-9);
//! # Ok::<(), revmap::Error>(())
//! ```

use crate::error::Result;
use crate::scene::{Cluster, GrownProfiles, Object, Placement, ends};
use crate::surface::{
    ContourSource, FitOptions, QuadricPatch, ROWS, extent, extents, fit_patches, touched,
};
use glam::{DVec2, DVec3};
use std::f64::consts::SQRT_2;
use std::ops::Range;

/// The first point of a ray on a solid's boundary.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RayHit {
    /// The point is `origin + t direction`.
    pub t: f64,
    /// Index of the copy; 0 without copies.
    pub copy: usize,
    /// Unit outward normal, world axes, without bumps.
    pub normal: DVec3,
    /// True if the ray starts in the solid and leaves it here.
    pub leaves: bool,
}

/// An object prepared for rays. It keeps the values that the object had.
pub struct RayCaster {
    object: Object,
    patches: Vec<QuadricPatch>,
    /// Least and largest `r^2` of each row of height `1 / ROWS`.
    squares: Vec<[f32; 2]>,
    /// Numbers of the patches that reach into each row.
    rows: Vec<Vec<u32>>,
}

/// Crossings this near to a border of a cell count as the border, units of length of the ray in
/// object space.
const SKIN: f64 = 1e-10;
/// Hits whose `t` differ by less than this part are of one point.
const AT_ONCE: f64 = 1e-9;
/// A root this far beyond its row, as a part of the ray, still counts in it.
const MARGIN: f64 = 1e-6;

impl RayCaster {
    /// Prepares an object.
    ///
    /// # Errors
    /// [`ErrorKind::Content`](crate::error::ErrorKind::Content) if the profile has no surface, or
    /// its contour under the offset does not close.
    pub fn new(object: &Object) -> Result<Self> {
        let grown = GrownProfiles::default().grown(object);
        let object = grown.map_or_else(|| object.clone(), |grown| grown.object);
        let source = ContourSource::new(&object.profile.outline)?;
        let contour = source.contour(&object.offset)?;
        let patches = fit_patches(&contour, &FitOptions::default());
        let mut rows = vec![Vec::new(); ROWS as usize];
        for (n, patch) in (0..).zip(&patches) {
            rows[touched(patch, ROWS as usize)]
                .iter_mut()
                .for_each(|row| row.push(n));
        }
        Ok(Self {
            squares: extents(&patches, ROWS as usize),
            rows,
            patches,
            object,
        })
    }

    /// The first hit at `t >= 0` of a ray of the world; where copies coincide, that of the first
    /// one. A ray that starts in a copy hits the point where it leaves that copy. A ray with a
    /// number that is not finite, or without a direction, hits nothing.
    #[must_use]
    pub fn cast(&self, origin: DVec3, direction: DVec3) -> Option<RayHit> {
        let valid = origin.is_finite() && direction.length_squared().is_normal();
        let mut best: Option<RayHit> = None;
        let mut most = f64::INFINITY;
        let mut try_copy = |copy: usize, placement: &Placement| {
            if let Some(hit) = self.cast_copy(placement, origin, direction, most) {
                let is_first = |b: RayHit| copy < b.copy || hit.t * (1.0 + AT_ONCE) < b.t;
                if best.is_none_or(is_first) {
                    best = Some(RayHit { copy, ..hit });
                }
                most = most.min(hit.t * (1.0 + AT_ONCE));
            }
            most
        };
        if self.object.instances.is_empty() {
            valid.then(|| try_copy(0, &self.object.placement));
            return best;
        }
        let clusters = self.object.instances.clusters();
        let reach = [SQRT_2 * self.object.profile.radius, 1.0];
        let all = clusters.all().iter().filter(|_| valid);
        let mut near: Vec<(f64, &Cluster)> = all
            .filter_map(|cluster| Some((entry(cluster, reach, origin, direction)?, cluster)))
            .collect();
        near.sort_unstable_by(|a, b| a.0.total_cmp(&b.0));
        let mut nearest = f64::INFINITY;
        for (entry, cluster) in near {
            if entry > nearest {
                break;
            }
            for place in cluster.range.clone() {
                let (copy, placement) = clusters.at(place);
                nearest = try_copy(copy as usize, placement);
            }
        }
        best
    }

    /// The least box, in world axes, around the solids of all copies: their largest radius and
    /// range of heights under the offset, or the whole boxes of replicas. `None` if no part of the
    /// solid is left.
    #[must_use]
    pub fn bounds(&self) -> Option<[DVec3; 2]> {
        let [[_, radius], [low, high]] = extent(&self.patches);
        let side = self.object.profile.radius;
        if self.object.repeat != [1; 3] {
            let whole = [[-side, side], [-side, side], [0.0, 1.0]];
            return (radius > 0.0).then(|| self.box_around(whole));
        }
        // The box cuts what is beyond its sides.
        let ends = |o: f64| [(o - radius).max(-side), (o + radius).min(side)];
        let [x, y] = self.object.axis_offset().map(ends);
        (radius > 0.0).then(|| self.box_around([x, y, [low, high]]))
    }

    /// The world's box around a box of object space, of all copies.
    fn box_around(&self, sides: [[f64; 2]; 3]) -> [DVec3; 2] {
        let low = DVec3::from(sides.map(|e| e[0]));
        let high = DVec3::from(sides.map(|e| e[1]));
        let (middle, half) = (0.5 * (low + high), 0.5 * (high - low));
        let (low, high) = ends(self.object.placements().iter().flat_map(|p| {
            let axes = [DVec3::X, DVec3::Y, DVec3::Z].map(|axis| (p.rotation * axis).abs());
            let size = half * p.scale;
            let reach = axes[0] * size.x + axes[1] * size.y + axes[2] * size.z;
            let centre = p.position + p.rotation * (middle * p.scale);
            [centre - reach, centre + reach]
        }));
        [low, high]
    }

    fn cast_copy(
        &self,
        placement: &Placement,
        origin: DVec3,
        direction: DVec3,
        most: f64,
    ) -> Option<RayHit> {
        let back = placement.rotation.conjugate();
        let local = back * (origin - placement.position) / placement.scale;
        let along = back * direction / placement.scale;
        let clip =
            Clip::new(self.object.profile.radius, local, along).filter(|clip| clip.t[0] < most)?;
        let mut found = self.walk(&clip, local, along)?;
        found.normal = (placement.rotation * (found.normal / placement.scale)).normalize_or_zero();
        (found.t < most).then_some(found)
    }

    /// Walks the cells of replicas along a ray of object space. The boundary is where the state of
    /// the ray, in the solid or not, changes.
    fn walk(&self, clip: &Clip, origin: DVec3, direction: DVec3) -> Option<RayHit> {
        let start = origin + direction * clip.t[0];
        let skin = SKIN * (1.0 + start.length()) / direction.length();
        let cuts = self.cuts(start, direction, clip);
        let mut before = (!clip.from_within).then_some(false);
        let mut first = true;
        let hit = |t: f64, normal: DVec3, leaves: bool| RayHit {
            t: clip.t[0] + t,
            copy: 0,
            normal,
            leaves,
        };
        let face = |t: f64, axis: usize, leaves: bool| {
            let mut normal = DVec3::ZERO;
            normal[axis] = direction[axis].signum() * if leaves { 1.0 } else { -1.0 };
            hit(t, normal, leaves)
        };
        for pair in cuts.windows(2) {
            let ((low, axis), (high, _)) = (pair[0], pair[1]);
            let (a, b) = (low + skin, high - skin);
            if a >= b {
                continue;
            }
            let ray = Meridian::new(self, start, direction, 0.5 * (a + b), a);
            let within = self.contains(ray.o);
            if before.is_some_and(|before| before != within) {
                return Some(face(low, axis, !within && !first));
            }
            if let Some((t, gradient)) = self.search(&ray, b - a, within) {
                return Some(hit(a + t, gradient * ray.factor, within));
            }
            (before, first) = (Some(within), false);
        }
        let (t, axis) = cuts[cuts.len() - 1];
        (before == Some(true)).then(|| face(t, axis, true))
    }

    /// True if a point of a cell is in the solid: the number of patches outward of it is odd.
    fn contains(&self, p: DVec3) -> bool {
        let square = p.x * p.x + p.y * p.y;
        let Some(row) = rows_of(p.z, p.z).next() else {
            return false;
        };
        let outward = |patch: &&QuadricPatch| {
            let spans = patch.z[0] <= p.z && p.z < patch.z[1];
            spans && !patch.is_plane() && patch.square_at(p.z) > square
        };
        self.row(row).filter(outward).count() % 2 == 1
    }

    fn row(&self, row: usize) -> impl Iterator<Item = &QuadricPatch> {
        self.rows[row].iter().map(|&n| &self.patches[n as usize])
    }

    /// The first root in `0..end` at which the ray of a replica enters the solid, or leaves it if it
    /// starts `within`, and the gradient there. Rows come in the order of the ray.
    fn search(&self, ray: &Meridian, end: f64, within: bool) -> Option<(f64, DVec3)> {
        let (start, slope) = (ray.o.z, ray.v.z);
        let up = slope >= 0.0;
        let last = start + end * slope;
        let mut range = rows_of(start.min(last), start.max(last));
        let mut from = 0.0;
        loop {
            let row = if up { range.next() } else { range.next_back() }?;
            let border = (row + usize::from(up)) as f64 / f64::from(ROWS);
            let leave = (border - start) / slope;
            let leave = Some(leave).filter(|t| t.is_finite());
            let leave = leave.map_or(end, |leave| leave.clamp(from, end));
            let [least, most] = ray.squares(from, leave);
            let [inner, outer] = self.squares[row].map(f64::from);
            if least <= outer && most >= inner {
                let found = (self.row(row))
                    .filter_map(|patch| Some((ray.root(patch, end, within)?, patch)))
                    .min_by(|a, b| a.0.total_cmp(&b.0));
                if let Some((t, patch)) = found.filter(|(t, _)| *t <= leave + MARGIN * end) {
                    return Some((t, ray.gradient(patch, t)));
                }
            }
            from = leave;
        }
    }

    /// The values of `t`, from the start of the ray in the box, at which it passes from cell to
    /// cell, with the axis of each plane, in order; the ends of the box are included.
    fn cuts(&self, start: DVec3, direction: DVec3, clip: &Clip) -> Vec<(f64, usize)> {
        let length = clip.t[1] - clip.t[0];
        let mut cuts = vec![(0.0, clip.axis[0])];
        for axis in 0..3 {
            let (low, size) = self.side(axis);
            let n = self.object.repeat[axis].max(1);
            let at = |k| low + size * f64::from(k) / f64::from(n);
            let planes = (1..n).map(|k| (at(k) - start[axis]) / direction[axis]);
            let inside = planes.filter(|t| *t > 0.0 && *t < length);
            cuts.extend(inside.map(|t| (t, axis)));
        }
        cuts.sort_by(|p, q| p.0.total_cmp(&q.0));
        cuts.push((length, clip.axis[1]));
        cuts
    }

    /// The lowest coordinate of the box along an axis, and its size.
    fn side(&self, axis: usize) -> (f64, f64) {
        let radius = self.object.profile.radius;
        if axis < 2 {
            (-radius, 2.0 * radius)
        } else {
            (0.0, 1.0)
        }
    }
}

fn rows_of(low: f64, high: f64) -> Range<usize> {
    let rows = f64::from(ROWS);
    let row = |z: f64| (z * rows).floor().clamp(0.0, rows - 1.0) as usize;
    row(low)..row(high) + 1
}

/// The least `t` at which a ray may enter a cluster of copies; `None` if it passes them.
fn entry(cluster: &Cluster, reach: [f64; 2], origin: DVec3, direction: DVec3) -> Option<f64> {
    let around = cluster.around(origin, reach);
    let (u, v) = direction.normalize().any_orthonormal_pair();
    let contains = |[low, high]: [f64; 2]| low <= 0.0 && high >= 0.0;
    let [low, high] = around.along(direction / direction.length_squared());
    (high >= 0.0 && contains(around.along(u)) && contains(around.along(v))).then_some(low.max(0.0))
}

/// The part of a ray within a box.
struct Clip {
    t: [f64; 2],
    /// Axes of the faces of entry and exit.
    axis: [usize; 2],
    from_within: bool,
}

impl Clip {
    fn new(side: f64, origin: DVec3, direction: DVec3) -> Option<Self> {
        let mut clip = Self {
            t: [f64::NEG_INFINITY, f64::INFINITY],
            axis: [0; 2],
            from_within: false,
        };
        for (axis, ends) in [[-side, side], [-side, side], [0.0, 1.0]]
            .iter()
            .enumerate()
        {
            if direction[axis] == 0.0 {
                if origin[axis] < ends[0] || origin[axis] > ends[1] {
                    return None;
                }
                continue;
            }
            let [a, b] = ends.map(|face| (face - origin[axis]) / direction[axis]);
            if a.min(b) > clip.t[0] {
                (clip.t[0], clip.axis[0]) = (a.min(b), axis);
            }
            if a.max(b) < clip.t[1] {
                (clip.t[1], clip.axis[1]) = (a.max(b), axis);
            }
        }
        if clip.t[0] < 0.0 {
            (clip.t[0], clip.from_within) = (0.0, true);
        }
        (clip.t[1] > clip.t[0]).then_some(clip)
    }
}

/// A ray in the space of one replica, whose axis of revolution is x = y = 0. In the half-plane it is
/// `r^2 = a t^2 + 2 b t + c`, `z = o_z + t v_z`.
struct Meridian {
    o: DVec3,
    v: DVec3,
    a: f64,
    b: f64,
    c: f64,
    /// Units of the replica for each object unit; negative along an axis that is reflected.
    factor: DVec3,
}

impl Meridian {
    /// A ray from `begin` on, in the replica that it is in at `middle`.
    fn new(of: &RayCaster, start: DVec3, direction: DVec3, middle: f64, begin: f64) -> Self {
        let point = start + direction * begin;
        let (mut factor, mut o) = (DVec3::ZERO, DVec3::ZERO);
        for axis in 0..3 {
            let n = f64::from(of.object.repeat[axis].max(1));
            let (low, size) = of.side(axis);
            let place = |x: f64| (x - low) / size * n;
            let index = place(start[axis] + direction[axis] * middle);
            let index = index.floor().clamp(0.0, n - 1.0);
            let reflected = of.object.mirror[axis] && index % 2.0 == 1.0;
            let fraction = place(point[axis]) - index;
            factor[axis] = if reflected { -n } else { n };
            o[axis] = low + size * if reflected { 1.0 - fraction } else { fraction };
        }
        o -= DVec2::from(of.object.axis_offset()).extend(0.0);
        let v = direction * factor;
        let (flat, way) = (o.truncate(), v.truncate());
        Self {
            o,
            v,
            a: way.length_squared(),
            b: flat.dot(way),
            c: flat.length_squared(),
            factor,
        }
    }

    fn square_at(&self, t: f64) -> f64 {
        self.c + t * (2.0 * self.b + t * self.a)
    }

    /// Least and largest `r^2` between two values of `t`.
    fn squares(&self, from: f64, to: f64) -> [f64; 2] {
        let nearest = (-self.b / self.a.max(f64::MIN_POSITIVE)).clamp(from, to);
        let most = self.square_at(from).max(self.square_at(to));
        [self.square_at(nearest), most]
    }

    /// The root in `0..=end` at which the ray enters the solid through a patch, or leaves it.
    fn root(&self, patch: &QuadricPatch, end: f64, leaves: bool) -> Option<f64> {
        let (anchor, [a, k0, k1, k2]) = patch.about_anchor(|z| z);
        let side = if leaves { -1.0 } else { 1.0 };
        let (oz, vz) = (self.o.z, self.v.z);
        let h = oz - anchor;
        let al = side * (a * self.a + k2 * vz * vz);
        let be = side * (a * self.b + (0.5 * k1 + k2 * h) * vz);
        let ga = side * (a * self.c + k0 + h * (k1 + k2 * h));
        let root = (be * be - al * ga).sqrt();
        let t = if be <= 0.0 {
            ga / (root - be)
        } else {
            -(be + root) / al
        };
        let [cz, cr, low, high] = patch.guard;
        let place = cz * (oz + t * vz) + cr * self.square_at(t);
        (low <= place && place <= high && 0.0 <= t && t <= end).then_some(t)
    }

    /// The gradient of a patch's quadric, outward, at a point of the ray.
    fn gradient(&self, patch: &QuadricPatch, t: f64) -> DVec3 {
        let p = self.o + t * self.v;
        let [a, _, k1, k2] = patch.quadric;
        DVec3::new(2.0 * a * p.x, 2.0 * a * p.y, k1 + 2.0 * k2 * p.z)
    }
}
