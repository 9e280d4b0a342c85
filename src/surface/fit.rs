//! Chains cut into the longest quadrics that stay within a tolerance.
//!
//! Over a stretch on which `z` is monotone the boundary is a function `r^2(z)`. The quadrics with
//! `a = ±1` are the parabolas `r^2 = p(z)`. The ones through both ends of the stretch are one
//! family,
//!
//! ```text
//! p(z) = L(z) + q (z - za)(z - zb),   L linear with L(za) = ra^2, L(zb) = rb^2.
//! ```
//!
//! Let `(r, z)` be a sample of the boundary, whose direction there is `dr/dz = k`. The parabola
//! meets it within the tolerance `tau`, measured along the normal, if `sqrt(p)` is within `tau
//! sqrt(1 + k^2)` of `r`. The condition gives an interval of `p`, and so an interval of `q`. The
//! stretch can be one patch if the intervals of all samples have a common point. The function `r^2`
//! of a straight segment is itself such a parabola. The deviation between two corners is therefore
//! a parabola too, and corners and middles are enough samples.
//!
//! Stretches grow greedily. Neighbours share their ends exactly, so there are no gaps at the
//! joints.

use super::{Contour, QuadricPatch};
use glam::DVec2;

/// Options for cutting contours into patches.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FitOptions {
    /// Largest distance between contour and patches, object units, along the normal.
    pub tolerance: f64,
}

impl Default for FitOptions {
    /// A 285th of a texel of a map of 512 rows. The error grows sixfold along grazing rays, and the
    /// 99th percentile of all rays stays below a fiftieth of a texel.
    fn default() -> Self {
        Self {
            tolerance: 0.0035 / 512.0,
        }
    }
}

/// Rounding unit of the arithmetic that solves the quadrics.
const EPSILON: f64 = (f32::EPSILON / 2.0) as f64;
/// Least distance by which guards reach past a patch's ends, object units: a few roundings of
/// coordinates of size 1.
const OVERLAP: f64 = 1e-6;
/// Largest `|dr/dz|` at the end of a patch whose guard separates it from its neighbours only by
/// `z`.
const STEEP: f64 = 4.0;
/// A patch above this `|dr/dz|` is the flattest possible paraboloid. There `r^2` is almost linear
/// in `z`, so the quadric has no other sheet near. The guard can use `r`, and no division by small
/// differences occurs.
const FLAT: f64 = 8.0;
/// Largest distance along the boundary by which a guard may reach past a patch's end, if a shorter
/// patch reaches less far. Object units: less than a tenth of a texel of 512 rows. On a flat patch
/// with a sheet near, the guard uses only `z`, and a rounding of `z` moves `r` by `|dr/dz|` times
/// as much.
const REACH: f64 = 0.08 / 512.0;
/// Most bands of a flat segment. The widest that 32 bits draw need 240; with fewer bands, their guards
/// reach past the segment's ends.
const MOST_BANDS: f64 = 512.0;
/// Distance from the axis below which the resolution of radii grows no finer: `r^2` has an absolute
/// rounding error.
const SMALL: f64 = 0.05;
/// Segments that climb less than this are horizontal.
const LEVEL: f64 = 1e-9;

/// Cuts all chains of a contour, each in its own order. Patches of a chain are contiguous.
pub fn fit_patches(contour: &Contour, options: &FitOptions) -> Vec<QuadricPatch> {
    let mut patches = Vec::new();
    let mut cutter = Cutter::new(options.tolerance);
    for (number, chain) in contour.chains.iter().enumerate() {
        let first = patches.len();
        cutter.load(&chain.points, chain.closed);
        cutter.patches(number as u32, &mut patches);
        let last = patches.len();
        for (patch, k) in patches[first..].iter_mut().zip(first..) {
            patch.previous = (k > first).then(|| k as u32 - 1);
            patch.next = (k + 1 < last).then_some(k as u32 + 1);
        }
        if chain.closed && last > first {
            patches[first].previous = Some(last as u32 - 1);
            patches[last - 1].next = Some(first as u32);
        }
    }
    patches
}

/// A height of the boundary, and the interval of `r^2` that a patch may have there.
#[derive(Clone, Copy, Debug)]
struct Sample {
    z: f64,
    low: f64,
    high: f64,
}

#[derive(Debug, Default)]
struct Cutter {
    tolerance: f64,
    points: Vec<DVec2>,
    /// `samples[2 k]` is point `k`; `samples[2 k + 1]` is the middle between it and the next.
    samples: Vec<Sample>,
}

impl Cutter {
    fn new(tolerance: f64) -> Self {
        Self {
            tolerance: tolerance.max(1e-9),
            ..Self::default()
        }
    }

    /// Loads a chain. A closed one is rotated so that it begins and ends at a lowest point.
    fn load(&mut self, chain: &[DVec2], closed: bool) {
        self.points.clear();
        self.points.reserve(chain.len() + 1);
        if closed {
            let lowest = (0..chain.len())
                .min_by(|&j, &k| chain[j].y.total_cmp(&chain[k].y))
                .unwrap_or(0);
            let turned = chain[lowest..].iter().chain(&chain[..=lowest]);
            for &p in turned {
                self.push(p);
            }
        } else {
            for &p in chain {
                self.push(p);
            }
        }
        self.samples.clear();
        self.samples.reserve(2 * self.points.len());
        let mut before = f64::INFINITY;
        for pair in self.points.windows(2) {
            let s = pair[1] - pair[0];
            let after = self.tolerance * s.length() / s.y.abs().max(1e-300);
            let middle = (pair[0] + pair[1]) * 0.5;
            self.samples.push(Sample::new(pair[0], before.min(after)));
            self.samples.push(Sample::new(middle, after));
            before = after;
        }
        let last = self.points.last().map(|p| Sample::new(*p, before));
        self.samples.extend(last);
    }

    /// Appends a point. A nearly horizontal segment becomes horizontal. A segment too flat for
    /// solving its cone in 32 bits is divided into bands low enough for paraboloids.
    fn push(&mut self, mut p: DVec2) {
        let Some(&q) = self.points.last() else {
            self.points.push(p);
            return;
        };
        let climb = (p.y - q.y).abs();
        if climb < LEVEL {
            p.y = q.y;
        } else {
            self.push_bands(q, p, (p.x - q.x).abs() / climb);
        }
        self.points.push(p);
    }

    /// Appends the points between the bands of a segment from `q` to `p`, if it is too flat.
    fn push_bands(&mut self, q: DVec2, p: DVec2, slope: f64) {
        let (widest, bend) = (p.x.max(q.x), slope * slope);
        // A lower bound of largest_bend(): most segments pass without a square root.
        if slope <= FLAT && bend < self.bend_of_gradient() * widest {
            return;
        }
        let most = self.largest_bend(widest, 2.0 * widest * slope);
        if bend > most || (slope > FLAT && self.reach(q, p, bend) > REACH) {
            // Between radii r and r + d, a paraboloid through both ends is off by d^2 / (8 slope
            // r). The error is half of the tolerance where the roots of the radii are evenly
            // spaced.
            let [from, to] = [q.x, p.x].map(f64::sqrt);
            let bands = ((to - from).abs() / (slope * self.tolerance).sqrt()).ceil();
            let bands = bands.clamp(1.0, MOST_BANDS);
            for k in 1..bands as u32 {
                let root = from + (to - from) * f64::from(k) / bands;
                let share = (root * root - q.x) / (p.x - q.x);
                self.points.push(q.lerp(p, share));
            }
        }
    }

    /// The largest `|q|` for which 32-bit floats are accurate enough. The terms of `G`, up to `|q|`
    /// in size, are rounded. The error must stay below half of the tolerance times `|grad G|`.
    fn largest_bend(&self, r: f64, slope: f64) -> f64 {
        self.bend_of_gradient() * DVec2::new(2.0 * r, slope).length()
    }

    /// The largest `|q|` over `|grad G|`.
    fn bend_of_gradient(&self) -> f64 {
        0.5 * self.tolerance / EPSILON
    }

    fn patches(&self, chain: u32, out: &mut Vec<QuadricPatch>) {
        let n = self.points.len();
        let mut i = 0;
        while i + 1 < n {
            let way = direction(self.points[i], self.points[i + 1]);
            let mut end = i + 1;
            while end + 1 < n && direction(self.points[end], self.points[end + 1]) == way {
                end += 1;
            }
            if way == 0 {
                out.push(self.plane(i, end, chain));
                i = end;
                continue;
            }
            while i < end {
                let (j, bend) = self.longest(i, end);
                out.push(self.quadric(i, j, bend, chain));
                i = j;
            }
        }
    }

    /// The farthest point that one patch from point `i` can reach, and its `q`.
    fn longest(&self, i: usize, end: usize) -> (usize, f64) {
        let mut best = (i + 1, self.single(i));
        let mut step = 1;
        let mut fails = end + 1;
        while best.0 < end {
            let j = (best.0 + step).min(end);
            match self.bend(i, j) {
                Some(q) => {
                    best = (j, q);
                    step *= 2;
                }
                None => {
                    fails = j;
                    break;
                }
            }
        }
        while best.0 + 1 < fails.min(end + 1) {
            let j = usize::midpoint(best.0, fails);
            match self.bend(i, j) {
                Some(q) => best = (j, q),
                None => fails = j,
            }
        }
        best
    }

    /// `q` of the patch along a single segment: the cone, up to the largest bend. A flat segment
    /// has the smallest `|q|` within the tolerance.
    fn single(&self, i: usize) -> f64 {
        let (a, b) = (self.points[i], self.points[i + 1]);
        let slope = (b.x - a.x) / (b.y - a.y);
        let widest = a.x.max(b.x);
        if slope.abs() > FLAT
            && let Some(q) = self.within(i, i + 1)
        {
            return q;
        }
        let most = self.largest_bend(widest, 2.0 * widest * slope);
        (slope * slope).min(most)
    }

    /// A `q` with which one patch from point `i` to point `j` is distinct from its neighbours and
    /// stays within the tolerance.
    fn bend(&self, i: usize, j: usize) -> Option<f64> {
        let q = self.within(i, j)?;
        let (a, b) = (self.points[i], self.points[j]);
        let flat = (b.x - a.x).abs() > FLAT * (b.y - a.y).abs();
        (!flat || self.reach(a, b, q) <= REACH).then_some(q)
    }

    /// A `q` with which one patch from point `i` to point `j` stays within the tolerance.
    fn within(&self, i: usize, j: usize) -> Option<f64> {
        let (a, b) = (self.points[i], self.points[j]);
        let (pa, pb) = (a.x * a.x, b.x * b.x);
        let linear = (pb - pa) / (b.y - a.y);
        let widest = a.x.max(b.x);
        let most = self.largest_bend(widest, linear);
        let (mut low, mut high) = (-most, most);
        // The middle comes first, where the interval is mostly the narrowest.
        let (first, second) = self.samples[2 * i + 1..2 * j].split_at(j - i);
        for s in second.iter().chain(first.iter().rev()) {
            let straight = pa + linear * (s.z - a.y);
            // Negative, because the samples are between the ends.
            let factor = (s.z - a.y) * (s.z - b.y);
            if factor >= 0.0 {
                continue;
            }
            let (above, below) = (s.high - straight, s.low - straight);
            // A product takes less time than a quotient, and most samples narrow nothing.
            if above > low * factor && below < high * factor {
                continue;
            }
            low = low.max(above / factor);
            high = high.min(below / factor);
            if low > high {
                return None;
            }
        }
        let nearest = |q: f64| q.clamp(low, high);
        let middle = 0.5 * (low + high);
        if linear.abs() > 2.0 * widest * FLAT {
            return Some(nearest(0.0)).filter(|&q| separates(a, b, q));
        }
        // A wide interval permits bends that no guard separates: one without a turn may be in it.
        let monotone = (linear / (b.y - a.y)).abs();
        [middle, nearest(middle.clamp(-monotone, monotone))]
            .into_iter()
            .find(|&q| separates(a, b, q))
    }

    fn quadric(&self, i: usize, j: usize, q: f64, chain: u32) -> QuadricPatch {
        let (a, b) = (self.points[i], self.points[j]);
        let (p, slopes) = parabola(a, b, q);
        // On an upward stretch the solid is towards the axis.
        let side = (b.y - a.y).signum();
        let mut r = [a.x.min(b.x), a.x.max(b.x)];
        if slopes[0] * slopes[1] < 0.0 {
            let top = p[0] - p[1] * p[1] / (4.0 * q);
            let extreme = top.max(0.0).sqrt();
            r = [r[0].min(extreme), r[1].max(extreme)];
        }
        QuadricPatch {
            quadric: [side, -side * p[0], -side * p[1], -side * p[2]],
            start: a,
            end: b,
            z: [a.y.min(b.y), a.y.max(b.y)],
            r,
            guard: guard(self.weights(a, b, q, r[1]), a, b),
            chain,
            previous: None,
            next: None,
        }
    }

    /// The guard of a patch from `a` to `b`: the weights of `z` and `r^2`, and the amount by which
    /// it reaches past its values at the ends. `widest`: the largest `r`.
    fn weights(&self, a: DVec2, b: DVec2, q: f64, widest: f64) -> [f64; 3] {
        let (p, slopes) = parabola(a, b, q);
        let monotone = slopes[0] * slopes[1] >= 0.0;
        let rise = b.x * b.x - a.x * a.x;
        let cr = if monotone && rise != 0.0 {
            let wanted = 1.0 / (2.0 * (0.5 * (a.x + b.x)).max(SMALL));
            let z = [a.y.min(b.y), a.y.max(b.y)];
            (rise / (b.y - a.y)).signum() * wanted.min(unambiguous(p, z))
        } else {
            0.0
        };
        // The size of the coefficients over the size of the gradient, which is the factor of their
        // rounding.
        let bend = (p[2].abs() + p[1].abs()) / slopes[0].hypot(2.0 * widest);
        [
            1.0,
            cr,
            OVERLAP + (4.0 * EPSILON * bend).min(self.tolerance),
        ]
    }

    /// Distance along the boundary by which the guard of a patch from `a` to `b` admits points past
    /// its ends.
    fn reach(&self, a: DVec2, b: DVec2, q: f64) -> f64 {
        let [cz, cr, overlap] = self.weights(a, b, q, a.x.max(b.x));
        let along = (b - a).normalize_or_zero();
        let growth = |r: f64| (cz * along.y + 2.0 * cr * r.max(SMALL) * along.x).abs();
        overlap / growth(a.x).min(growth(b.x))
    }

    fn plane(&self, i: usize, j: usize, chain: u32) -> QuadricPatch {
        let (a, b) = (self.points[i], self.points[j]);
        // On an inward stretch the solid is below.
        let side = if b.x < a.x { 1.0 } else { -1.0 };
        let cr = 1.0 / (2.0 * (0.5 * (a.x + b.x)).max(SMALL));
        QuadricPatch {
            quadric: [0.0, -side * a.y, side, 0.0],
            start: a,
            end: b,
            z: [a.y, a.y],
            r: [a.x.min(b.x), a.x.max(b.x)],
            guard: guard([0.0, cr, OVERLAP], a, b),
            chain,
            previous: None,
            next: None,
        }
    }
}

/// True if a guard can separate a patch from its neighbours: by length along the boundary, if `r` is
/// monotone; else by `z`, if its ends are steep.
fn separates(a: DVec2, b: DVec2, q: f64) -> bool {
    let (_, slopes) = parabola(a, b, q);
    let steep = |(r, slope): (f64, f64)| r == 0.0 || slope.abs() <= 2.0 * r * STEEP;
    slopes[0] * slopes[1] >= 0.0 || [a.x, b.x].into_iter().zip(slopes).all(steep)
}

/// `[p0, p1, p2]` of the parabola through both ends, and its slopes there.
fn parabola(a: DVec2, b: DVec2, q: f64) -> ([f64; 3], [f64; 2]) {
    let (pa, climb) = (a.x * a.x, b.y - a.y);
    let linear = (b.x * b.x - pa) / climb;
    let p = [
        pa - linear * a.y + q * a.y * b.y,
        linear - q * (a.y + b.y),
        q,
    ];
    (p, [linear - q * climb, linear + q * climb])
}

fn guard([cz, cr, overlap]: [f64; 3], a: DVec2, b: DVec2) -> [f64; 4] {
    let place = |p: DVec2| cz * p.y + cr * p.x * p.x;
    let (from, to) = (place(a), place(b));
    [cz, cr, from.min(to) - overlap, from.max(to) + overlap]
}

/// The largest weight of `r^2` in a guard at which the quadric's other sheet fails the guard
/// everywhere in the box.
///
/// On `r^2 = p(z)` the guard's value `z + w p(z)` (for a rising `p`) is a parabola in `z`. The
/// turning point is `1 / (2 |q| w)` beyond the turning point of `p`. The guard takes the patch's
/// values again at the same distance on the other side. Those points must be beyond floor or
/// ceiling.
fn unambiguous([_, p1, q]: [f64; 3], [low, high]: [f64; 2]) -> f64 {
    const BEYOND: f64 = 0.01;
    if q == 0.0 {
        return f64::INFINITY;
    }
    let turn = -0.5 * p1 / q;
    let distance = if turn > 0.5 * (low + high) {
        0.5 * (1.0 + BEYOND + high) - turn
    } else {
        turn - 0.5 * (low - BEYOND)
    };
    if distance > 0.0 {
        0.5 / (q.abs() * distance)
    } else {
        f64::INFINITY
    }
}

impl Sample {
    fn new(p: DVec2, reach: f64) -> Self {
        let (low, high) = ((p.x - reach).max(0.0), p.x + reach);
        Self {
            z: p.y,
            low: low * low,
            high: high * high,
        }
    }
}

/// 1 if the boundary goes up, -1 if it goes down, 0 if it is level.
fn direction(a: DVec2, b: DVec2) -> i32 {
    if a.y < b.y {
        1
    } else if a.y > b.y {
        -1
    } else {
        0
    }
}
