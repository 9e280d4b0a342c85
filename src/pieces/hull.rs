//! Shells of triangles around the pieces, so that a rasteriser finds the piece that a ray meets.
//!
//! # Cells
//!
//! Up to [`HullOptions::tests`] consecutive pieces of a chain are a **cell**. Around its surface, on the empty side, lies a shell: frusta along
//! it, and walls at its two ends, from the frusta down to the surface and a little into the solid. Shell and surface enclose the cell's part
//! of the empty space. A ray from outside that first meets the solid on one of the cell's pieces was in that part just before; it came
//! in through the shell (through the surface it would have come out of the solid, which it then had met before). So
//!
//! > a fragment of a front-facing triangle tests the pieces of its own cell, no others, and the nearest fragment is the first hit.
//!
//! No ray is lost however flat it glides along the surface, whichever way the profile folds: chains, undercuts and cavities
//! need no care, and what a fragment finds is a true point of the boundary in every case. It holds for eyes outside all shells
//! ([`Hull::clear_of`]) and solids that the box's side faces do not cut.
//!
//! Besides the guard a fragment has to ask whether `z` is that of the box (to within [`FLOOR`]): beyond it another sheet of a quadric can
//! pass the guard.
//!
//! # Bands
//!
//! The shell of a cell is a polyline in the half-plane; each of its parts, turned about the axis in `n` steps, is a **band** of `2 n`
//! triangles. A band is as long as the surface stays within [`HullOptions::gap`] of it: it lies along the surface's chord, moved outwards to
//! touch it (the support line; the extremes of a quadric's meridian above a line are the roots of a quadratic). Where two bands meet
//! at a bulge they are prolonged to their intersection, in a hollow cut at it, else joined by a third.
//!
//! A regular polygon of `n` corners at radius `f r` contains the circle of radius `r` with `f = 1 / cos(pi / n)`, and lies in it with
//! `f = 1`. Walls that look away from the axis take the first, walls that look towards it the second, planes the one at their outer rim and
//! the other at the inner. The radii of [`Band`] are those of the corners.
//!
//! # Growing it in a vertex shader
//!
//! `6 n` corners for each band (a vertex shader makes the `2 n` different ones from their number, an index buffer repeats them). Of corner `v`: `band = v / (6 n)`, `side = v % (6 n) / 6`, and by `v % 6` the corners
//! `A_side, A_side+1, B_side+1, A_side, B_side+1, B_side`, where ring `A` is `from`, `B` is `to`, and corner `s` stands at the azimuth
//! `2 pi s / n`. Counter-clockwise is front. [`Band::corner`] is the same on the CPU.

use super::rows::Record;
use super::walk::entering_root;
use super::{Piece, Walk};
use bytemuck::{Pod, Zeroable};
use glam::{DVec2, DVec3, Vec3};

/// How shells are made.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HullOptions {
    /// Corners of the rings, at least 3.
    pub sides: u32,
    /// Most pieces of a cell: what a fragment tests.
    pub tests: u32,
    /// How far the surface may lie below a band before it is divided, object units.
    pub gap: f64,
    /// By how much bands are moved outwards beyond what touches, object units: a rasteriser moves corners by fractions of a pixel.
    pub margin: f64,
}

impl Default for HullOptions {
    /// What charted best (docs/searches.md): few triangles, at the price of fragments that meet nothing.
    fn default() -> Self {
        Self {
            sides: 12,
            tests: 8,
            gap: 0.03,
            margin: 1e-4,
        }
    }
}

/// A ring of triangles between two regular polygons, in the layout of a storage buffer: 32 bytes.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct Band {
    /// Radius of the corners and height of the ring where it begins.
    pub from: [f32; 2],
    /// The same where it ends; seen along `(from, to)` the solid lies on the left.
    pub to: [f32; 2],
    /// The cell's first piece.
    pub first: u32,
    /// Number of the cell's pieces, which stand one after the other.
    pub count: u32,
    /// Number of the cell.
    pub cell: u32,
    /// Keeps the next band at a multiple of 16 bytes.
    pub pad: u32,
}

/// The shells of all cells.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Hull {
    /// Corners of each ring.
    pub sides: u32,
    /// All bands, cell by cell.
    pub bands: Vec<Band>,
    /// What each cell's shell occupies: `[r min, r max, z min, z max]`.
    pub extents: Vec<[f64; 4]>,
}

/// By how much `z` of a hit may lie below the floor or above the ceiling: more than roundings, less than what guards tell apart.
pub const FLOOR: f32 = 1e-3;

/// Walls reach at least this far into the solid, object units.
const ROOT: f64 = 1e-4;

impl Band {
    /// Corner number `corner` (0 to `6 n - 1`) of its triangles.
    #[must_use]
    pub fn corner(&self, corner: u32, sides: u32) -> Vec3 {
        let (step, [r, z]) = self.place(corner);
        let angle = step as f32 * (std::f32::consts::TAU / sides as f32);
        let (sin, cos) = angle.sin_cos();
        Vec3::new(r * cos, r * sin, z)
    }

    /// The step of a corner's azimuth, and its ring.
    fn place(&self, corner: u32) -> (u32, [f32; 2]) {
        let (side, which) = (corner / 6, corner % 6);
        let step = side + u32::from(matches!(which, 1 | 2 | 4));
        let begins = matches!(which, 0 | 1 | 3);
        (step, if begins { self.from } else { self.to })
    }
}

impl Hull {
    /// The shells around pieces that [`cut`](super::cut) made.
    #[must_use]
    pub fn new(pieces: &[Piece], options: &HullOptions) -> Self {
        let sides = options.sides.max(3);
        let mut hull = Self {
            sides,
            ..Self::default()
        };
        let widen = 1.0 / (std::f64::consts::PI / f64::from(sides)).cos();
        let most = options.tests.clamp(1, 255) as usize;
        let mut first = 0;
        while first < pieces.len() {
            let chain = pieces[first].chain;
            let left = pieces[first..]
                .iter()
                .take_while(|p| p.chain == chain)
                .count();
            // Cells of a chain as even as can be: the largest decides what every fragment tests.
            let count = left.div_ceil(left.div_ceil(most));
            let cell = &pieces[first..first + count];
            let points = Shell { options, widen }.of(cell);
            hull.push(&points, first, count);
            first += count;
        }
        hull
    }

    fn push(&mut self, points: &[[DVec2; 2]], first: usize, count: usize) {
        let mut extent = [f64::INFINITY, 0.0, f64::INFINITY, f64::NEG_INFINITY];
        for [a, b] in points {
            for p in [a, b] {
                extent[0] = extent[0].min(p.x);
                extent[1] = extent[1].max(p.x);
                extent[2] = extent[2].min(p.y);
                extent[3] = extent[3].max(p.y);
            }
            let flat = |p: &DVec2| [p.x as f32, p.y as f32];
            if flat(a) != flat(b) {
                self.bands.push(Band {
                    from: flat(a),
                    to: flat(b),
                    first: first as u32,
                    count: count as u32,
                    cell: self.extents.len() as u32,
                    pad: 0,
                });
            }
        }
        // Flat sides lie nearer to the axis than their corners.
        extent[0] *= (std::f64::consts::PI / f64::from(self.sides)).cos();
        self.extents.push(extent);
    }

    /// Pieces of the largest cell.
    #[must_use]
    pub fn tests(&self) -> u32 {
        self.bands.iter().map(|b| b.count).max().unwrap_or(0)
    }

    /// Vertices of the whole draw.
    #[must_use]
    pub fn vertices(&self) -> u32 {
        self.bands.len() as u32 * 6 * self.sides
    }

    /// Whether an eye at `(r, z)` is outside all shells by at least `margin`; if not, front faces may be behind it.
    #[must_use]
    pub fn clear_of(&self, eye: DVec2, margin: f64) -> bool {
        self.extents.iter().all(|e| {
            eye.x < e[0] - margin
                || eye.x > e[1] + margin
                || eye.y < e[2] - margin
                || eye.y > e[3] + margin
        })
    }

    /// What rasteriser and fragments make of a ray `o + t v` about the axis, from an eye outside: its nearest fragment.
    #[must_use]
    pub fn trace(&self, records: &[Record], o: DVec3, v: DVec3) -> Walk {
        let mut walk = Walk::default();
        let circle: Vec<DVec2> = (0..=self.sides)
            .map(|k| {
                DVec2::from_angle(std::f64::consts::TAU * f64::from(k) / f64::from(self.sides))
            })
            .collect();
        for band in &self.bands {
            for triangle in 0..2 * self.sides {
                let corner = |k| {
                    let (step, [r, z]) = band.place(3 * triangle + k);
                    (circle[step as usize] * f64::from(r)).extend(f64::from(z))
                };
                if !enters(o, v, [corner(0), corner(1), corner(2)]) {
                    continue;
                }
                walk.nodes += 1;
                let cell = &records[band.first as usize..][..band.count as usize];
                for record in cell {
                    walk.pieces += 1;
                    // Near the solid, as shaders start their rays at the box.
                    let near = -o.dot(v) / v.length_squared();
                    let (o, v) = ((o + v * near).as_vec3(), v.as_vec3());
                    let flat = [
                        v.x * v.x + v.y * v.y,
                        o.x * v.x + o.y * v.y,
                        o.x * o.x + o.y * o.y,
                    ];
                    let root = entering_root(record.quadric, 1.0, flat, [o.z, v.z]);
                    let [cz, cr, low, high] = record.guard;
                    let square = flat[2] + root * (2.0 * flat[1] + root * flat[0]);
                    let z = o.z + root * v.z;
                    let place = cz * z + cr * square;
                    let t = root + near as f32;
                    let valid =
                        place >= low && place <= high && (-FLOOR..=1.0 + FLOOR).contains(&z);
                    if valid && walk.hit.is_none_or(|(best, _)| t < best) {
                        walk.hit = Some((t, *record));
                    }
                }
            }
        }
        walk
    }
}

/// Whether a ray passes a triangle against its normal.
fn enters(o: DVec3, v: DVec3, [a, b, c]: [DVec3; 3]) -> bool {
    let normal = (b - a).cross(c - a);
    if normal.dot(v) >= 0.0 || normal.dot(a - o) >= 0.0 {
        return false;
    }
    let side = |p: DVec3, q: DVec3| (q - o).cross(p - o).dot(v);
    let (x, y, z) = (side(a, b), side(b, c), side(c, a));
    x >= 0.0 && y >= 0.0 && z >= 0.0
}

/// A part of a cell's surface on one piece, from one height to another (of a plane: from one radius to another).
#[derive(Clone, Copy, Debug)]
struct Span {
    from: DVec2,
    to: DVec2,
    piece: usize,
}

struct Shell<'a> {
    options: &'a HullOptions,
    /// `1 / cos(pi / n)`.
    widen: f64,
}

impl Shell<'_> {
    /// The polyline of a cell's shell, in the meridian through the polygons' corners.
    ///
    /// Pieces shorter than the margin have no direction to build on, and no need: what wraps their neighbours wraps them.
    fn of(&self, cell: &[Piece]) -> Vec<[DVec2; 2]> {
        let long = |p: &&Piece| p.start.distance(p.end) > self.options.margin;
        let kept: Vec<Piece> = cell.iter().filter(long).copied().collect();
        let cell = if kept.is_empty() { cell } else { &kept };
        let mut bands: Vec<[DVec2; 2]> = Vec::new();
        let mut from = 0;
        while from < cell.len() {
            let a = cell[from].quadric[0];
            let mut to = from + 1;
            while to < cell.len() && cell[to].quadric[0] == a && a != 0.0 {
                to += 1;
            }
            let spans: Vec<Span> = (from..to)
                .map(|piece| Span {
                    from: cell[piece].start,
                    to: cell[piece].end,
                    piece,
                })
                .collect();
            self.follow(cell, &spans, 0, &mut bands);
            from = to;
        }
        let mut shell = joined(bands);
        self.wall_off(cell, &mut shell);
        shell
    }

    /// Bands along spans that look the same way, in or out (or one plane).
    fn follow(&self, cell: &[Piece], spans: &[Span], depth: u32, out: &mut Vec<[DVec2; 2]>) {
        let [first, .., last] = spans else {
            if let [one] = spans {
                self.follow_one(cell, *one, depth, out);
            }
            return;
        };
        let (a, b) = (first.from, last.to);
        let outward = outward(a, b);
        let along = (b - a).normalize_or_zero();
        let mut extent = [0.0f64; 2];
        let mut farthest = (0.0, 1);
        // By how much a joint lies beyond the chord's ends: a rim that turns back within the gap.
        let mut beyond = (self.options.margin, None);
        for (k, s) in spans.iter().enumerate() {
            for (height, _) in extremes(&cell[s.piece], s, a, outward) {
                extent = [extent[0].min(height), extent[1].max(height)];
            }
            let height = (s.from - a).dot(outward).abs();
            if k > 0 && height >= farthest.0 {
                farthest = (height, k);
            }
            let place = (s.from - a).dot(along);
            let over = (-place).max(place - a.distance(b));
            if k > 0 && over > beyond.0 {
                beyond = (over, Some(k));
            }
        }
        if let (_, Some(turn)) = beyond {
            let (left, right) = spans.split_at(turn);
            self.follow(cell, left, depth + 1, out);
            self.follow(cell, right, depth + 1, out);
            return;
        }
        if extent[1] - extent[0] <= self.options.gap || depth > 40 {
            out.push(self.band(&cell[first.piece], a, b, outward * extent[1]));
            return;
        }
        let (left, right) = spans.split_at(farthest.1);
        self.follow(cell, left, depth + 1, out);
        self.follow(cell, right, depth + 1, out);
    }

    fn follow_one(&self, cell: &[Piece], span: Span, depth: u32, out: &mut Vec<[DVec2; 2]>) {
        let piece = &cell[span.piece];
        let (a, b) = (span.from, span.to);
        let outward = outward(a, b);
        let heights = extremes(piece, &span, a, outward);
        let low = heights.iter().fold(0.0f64, |m, h| m.min(h.0));
        let high = heights.iter().fold(0.0f64, |m, h| m.max(h.0));
        let farthest = heights
            .iter()
            .max_by(|p, q| p.0.abs().total_cmp(&q.0.abs()))
            .map(|h| h.1);
        match farthest {
            Some(place) if high - low > self.options.gap && depth < 12 => {
                for (from, to) in [(a, place), (place, b)] {
                    self.follow_one(cell, Span { from, to, ..span }, depth + 1, out);
                }
            }
            _ => out.push(self.band(piece, a, b, outward * high)),
        }
    }

    /// The band over a chord, moved outwards.
    fn band(&self, piece: &Piece, a: DVec2, b: DVec2, shift: DVec2) -> [DVec2; 2] {
        let margin = outward(a, b) * self.options.margin;
        let rim = |p: DVec2, other: DVec2| {
            let factor = match piece.quadric[0] {
                1.0 => self.widen,
                -1.0 => 1.0,
                _ if p.x > other.x => self.widen,
                _ => 1.0,
            };
            let q = p + shift + margin;
            DVec2::new(q.x.max(0.0) * factor, q.y)
        };
        let [mut from, mut to] = [rim(a, b), rim(b, a)];
        if piece.is_plane() {
            // Its own rims: what the neighbours' margins leave out.
            let way = (to - from).normalize_or_zero() * self.options.margin;
            (from, to) = (from - way, to + way);
            (from.x, to.x) = (from.x.max(0.0), to.x.max(0.0));
        }
        [from, to]
    }

    /// Walls at both ends.
    fn wall_off(&self, cell: &[Piece], shell: &mut Vec<[DVec2; 2]>) {
        let (Some(&[begin, _]), Some(&[_, end])) = (shell.first(), shell.last()) else {
            return;
        };
        let on_axis = |p: DVec2| p.x == 0.0;
        if let Some(piece) = cell.last()
            && !(on_axis(piece.end) && on_axis(end))
        {
            shell.push([end, self.foot(piece, piece.end, end, end.y <= piece.end.y)]);
        }
        if let Some(piece) = cell.first()
            && !(on_axis(piece.start) && on_axis(begin))
        {
            let around = begin.y > piece.start.y;
            let foot = self.foot(piece, piece.start, begin, around);
            shell.insert(0, [foot, begin]);
        }
    }

    /// Where a wall ends that comes from `top`: through the joint, or rather through a polygon that keeps the joint's circle on the
    /// wall's inner side all round, and as far beyond as that polygon departs from the circle, so that no ray passes under the foot.
    ///
    /// A plane's rims are beyond its circles already: there walls stand upright.
    fn foot(&self, piece: &Piece, joint: DVec2, top: DVec2, around: bool) -> DVec2 {
        if piece.is_plane() {
            return DVec2::new(top.x, joint.y + (joint.y - top.y).signum() * ROOT);
        }
        let factor = if around { self.widen } else { 1.0 };
        let ring = DVec2::new(joint.x * factor, joint.y);
        let reach = (self.widen - 1.0) * joint.x + ROOT;
        let p = ring + (ring - top).normalize_or_zero() * reach;
        DVec2::new(p.x.max(0.0), p.y)
    }
}

/// Unit normal of a chord to its right: away from the solid.
fn outward(a: DVec2, b: DVec2) -> DVec2 {
    -(b - a).perp().normalize_or_zero()
}

/// Where on a span the height over the line through `a` is extreme: heights and places, besides the ends those points at which the
/// meridian `r = sqrt(p(z))` runs along the line: `p'^2 nr^2 = 4 nz^2 p`.
fn extremes(piece: &Piece, span: &Span, a: DVec2, normal: DVec2) -> Vec<(f64, DVec2)> {
    let height = |p: DVec2| (p - a).dot(normal);
    let mut found = vec![(height(span.from), span.from), (height(span.to), span.to)];
    if piece.is_plane() {
        return found;
    }
    let [side, k0, k1, k2] = piece.quadric;
    let [p0, p1, p2] = [-side * k0, -side * k1, -side * k2];
    let (r2, z2) = (normal.x * normal.x, normal.y * normal.y);
    let qa = 4.0 * p2 * (p2 * r2 - z2);
    let qb = 4.0 * p1 * (p2 * r2 - z2);
    let qc = p1 * p1 * r2 - 4.0 * z2 * p0;
    let root = (qb * qb - 4.0 * qa * qc).max(0.0).sqrt();
    let half = -0.5 * (qb + root.copysign(qb));
    let (low, high) = (span.from.y.min(span.to.y), span.from.y.max(span.to.y));
    for z in [half / qa, qc / half] {
        if z > low && z < high {
            let p = DVec2::new(piece.square_at(z).max(0.0).sqrt(), z);
            found.push((height(p), p));
        }
    }
    found
}

/// Joins bands end to start: at bulges at the intersection of their lines, in hollows where they cross, else by a band more.
fn joined(bands: Vec<[DVec2; 2]>) -> Vec<[DVec2; 2]> {
    let mut out: Vec<[DVec2; 2]> = Vec::with_capacity(bands.len());
    for mut band in bands {
        if let Some(last) = out.last_mut() {
            let (p, q) = (last[1], band[0]);
            let (u, v) = (last[1] - last[0], band[1] - band[0]);
            let cross = u.perp_dot(v);
            let x = (band[0] - last[0]).perp_dot(v) / cross;
            let y = (band[0] - last[0]).perp_dot(u) / cross;
            let meeting = last[0] + u * x;
            let sharp = meeting.distance(p) + meeting.distance(q) > 3.0 * p.distance(q);
            let bulge = x >= 1.0 && y <= 0.0 && !sharp && meeting.x >= 0.0;
            let hollow = (0.0..=1.0).contains(&x) && (0.0..=1.0).contains(&y);
            if p.distance_squared(q) < 1e-16 {
                band[0] = p;
            } else if bulge || hollow {
                (last[1], band[0]) = (meeting, meeting);
            } else {
                out.push([p, q]);
            }
        }
        out.push(band);
    }
    out
}
