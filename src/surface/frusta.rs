//! The shell of one cell: frusta along its surface, and walls at its ends. [`hull`](super::hull)
//! gives the purpose.

use super::QuadricPatch;
use glam::DVec2;

/// Slope `|dr/dz|` from which frusta reach past the ends of their patches.
const FLAT: f64 = 4.0;

/// Walls reach at least this far into the solid, object units: guards admit points up to 1.6e-4
/// past the ends of flat patches.
const ROOT: f64 = 2e-4;

/// Part of its radius by which a flat patch reaches past its rim at least: a sixteenth of a pixel, to
/// which some rasterisers round corners, where a wide solid fills a picture.
const RIM: f64 = 2e-4;

/// Parts of a wall's longest reach into the solid that are tried before the whole.
const REACHES: [f64; 4] = [0.0, 0.125, 0.25, 0.5];

/// Options for making shells.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ProxyHullOptions {
    /// Corners of the rings, at least 3.
    pub sides: u32,
    /// Most patches of a cell, all of which a fragment tests.
    pub patches_per_cell: u32,
    /// Largest distance of the surface below a frustum before the frustum is divided, object units.
    pub gap: f64,
    /// Distance by which frusta are moved outwards beyond touching, object units: a rasteriser
    /// moves corners by fractions of a pixel.
    pub margin: f64,
}

impl Default for ProxyHullOptions {
    /// The fastest values on llvmpipe (`docs/searches.md`): few triangles, at the cost of fragments
    /// without a hit.
    fn default() -> Self {
        Self {
            sides: 12,
            patches_per_cell: 8,
            gap: 0.03,
            margin: 1e-4,
        }
    }
}

/// A part of a cell's surface on one patch, between two heights, or between two radii for a plane.
#[derive(Clone, Copy, Debug)]
struct Span {
    from: DVec2,
    to: DVec2,
    patch: usize,
}

pub(super) struct FrustaBuilder<'a> {
    pub options: &'a ProxyHullOptions,
    /// All patches of the solid.
    pub patches: &'a [QuadricPatch],
    /// `1 / cos(pi / n)`.
    pub widen: f64,
}

impl FrustaBuilder<'_> {
    /// The polyline of a cell's shell, in the meridian through the polygons' corners.
    pub fn of(&self, cell: &[QuadricPatch]) -> Vec<[DVec2; 2]> {
        // Short patches are joined with longer ones, and yet a ray may meet them from behind a
        // plane.
        let is_single = cell.len() == 1;
        let cell = &self.without_short(cell);
        let mut shell = Vec::new();
        let mut frusta: Vec<[DVec2; 2]> = Vec::new();
        let mut from = 0;
        while from < cell.len() {
            let a = cell[from].quadric[0];
            let mut to = from + 1;
            while to < cell.len() && cell[to].quadric[0] == a && a != 0.0 {
                to += 1;
            }
            let spans: Vec<Span> = (from..to)
                .map(|patch| Span {
                    from: cell[patch].start,
                    to: cell[patch].end,
                    patch,
                })
                .collect();
            self.follow(cell, &spans, 0, &mut frusta);
            let is_ridge = from > 0 && a * cell[from - 1].quadric[0] < 0.0;
            let rims = is_ridge.then(|| self.rims(cell[from].start, a));
            join(&mut shell, &mut frusta, rims);
            from = to;
        }
        self.wall_off(cell, is_single, &mut shell);
        shell
    }

    /// A cell's patches, of which those shorter than the margin are joined with the next longer
    /// one, because they have no usable direction.
    fn without_short(&self, cell: &[QuadricPatch]) -> Vec<QuadricPatch> {
        let mut kept: Vec<QuadricPatch> = Vec::with_capacity(cell.len());
        for patch in cell {
            let start = kept.last().map_or(cell[0].start, |last| last.end);
            if start.distance(patch.end) > self.options.margin {
                kept.push(QuadricPatch { start, ..*patch });
            }
        }
        match (kept.last_mut(), cell.last()) {
            (Some(last), Some(end)) => last.end = end.end,
            _ => kept = cell.to_vec(),
        }
        kept
    }

    /// The rims of a ridge: the joint between a part that faces outwards and one that faces inwards
    /// (`a` is -1), or the reverse. Both are beyond the joint, as those of a plane without width:
    /// one goes around the joint's circle, the other is within.
    fn rims(&self, joint: DVec2, a: f64) -> [DVec2; 2] {
        let margin = self.options.margin;
        let around = joint * DVec2::new(self.widen, 1.0) + DVec2::new(margin, -a * margin);
        let within = DVec2::new((joint.x - margin).max(0.0), around.y);
        if a < 0.0 {
            [around, within]
        } else {
            [within, around]
        }
    }

    /// Adds frusta along spans that all face outwards, all face inwards, or are one plane.
    fn follow(&self, cell: &[QuadricPatch], spans: &[Span], depth: u32, out: &mut Vec<[DVec2; 2]>) {
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
        // Distance of a joint beyond the chord's ends: a rim that turns back within the gap.
        let mut beyond = (self.options.margin, None);
        for (k, s) in spans.iter().enumerate() {
            for (height, _) in extremes(&cell[s.patch], s, a, outward) {
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
            out.push(self.frustum(&cell[first.patch], a, b, outward * extent[1]));
            return;
        }
        let (left, right) = spans.split_at(farthest.1);
        self.follow(cell, left, depth + 1, out);
        self.follow(cell, right, depth + 1, out);
    }

    fn follow_one(&self, cell: &[QuadricPatch], span: Span, depth: u32, out: &mut Vec<[DVec2; 2]>) {
        let patch = &cell[span.patch];
        let (a, b) = (span.from, span.to);
        let outward = outward(a, b);
        let heights = extremes(patch, &span, a, outward);
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
            _ => out.push(self.frustum(patch, a, b, outward * high)),
        }
    }

    /// The frustum over a chord, moved outwards.
    fn frustum(&self, patch: &QuadricPatch, a: DVec2, b: DVec2, shift: DVec2) -> [DVec2; 2] {
        let margin = outward(a, b) * self.options.margin;
        let rim = |p: DVec2, other: DVec2| {
            let factor = match patch.quadric[0] {
                1.0 => self.widen,
                -1.0 => 1.0,
                _ if p.x > other.x => self.widen,
                _ => 1.0,
            };
            let q = p + shift + margin;
            DVec2::new(q.x.max(0.0) * factor, q.y)
        };
        let [mut from, mut to] = [rim(a, b), rim(b, a)];
        if (to.x - from.x).abs() > FLAT * (to.y - from.y).abs() {
            // A plane extends its own rims over the part that the neighbours' margins leave out,
            // and a flat patch over that which its guard admits past its ends.
            let way = (to - from).normalize_or_zero();
            let past = |p: DVec2| self.options.margin.max(ROOT).max(RIM * p.x) * way;
            (from, to) = (from - past(from), to + past(to));
            (from.x, to.x) = (from.x.max(0.0), to.x.max(0.0));
        }
        [from, to]
    }

    fn wall_off(&self, cell: &[QuadricPatch], is_single: bool, shell: &mut Vec<[DVec2; 2]>) {
        let (Some(&[begin, _]), Some(&[_, end])) = (shell.first(), shell.last()) else {
            return;
        };
        let on_axis = |p: DVec2| p.x == 0.0;
        let wall = |patch: &QuadricPatch, joint: DVec2, top: DVec2| {
            if patch.is_plane() {
                let inner = if joint == patch.end {
                    patch.start
                } else {
                    patch.end
                };
                let feet = self.feet_of_plane(inner, joint, top);
                // A ray from behind meets no other patch.
                let count = if is_single { 1 } else { 2 };
                return feet[..count].to_vec();
            }
            let foot = self.foot(patch, joint, top);
            match self.is_open(patch, joint, top, foot) {
                true => self.level_feet(patch, joint).to_vec(),
                false => vec![foot],
            }
        };
        if let Some(patch) = cell.last()
            && !(on_axis(patch.end) && on_axis(end))
        {
            let mut from = end;
            for to in wall(patch, patch.end, end) {
                shell.push([from, to]);
                from = to;
            }
        }
        if let Some(patch) = cell.first()
            && !(on_axis(patch.start) && on_axis(begin))
        {
            let mut to = begin;
            for from in wall(patch, patch.start, begin) {
                shell.insert(0, [from, to]);
                to = from;
            }
        }
    }

    /// The foot of a wall that comes from `top`, for the `joint` at an end of a patch that is no
    /// plane. The wall goes through a polygon that keeps the joint's circle on its inner side all
    /// round. The wall continues beyond by the distance of that polygon from the circle.
    fn foot(&self, patch: &QuadricPatch, joint: DVec2, top: DVec2) -> DVec2 {
        // On the side of the patch, a wall of an outward part is around the circle.
        let around = beside(patch, joint, top) == (patch.quadric[0] > 0.0);
        let factor = if around { self.widen } else { 1.0 };
        let ring = DVec2::new(joint.x * factor, joint.y);
        let way = (ring - top).normalize_or_zero();
        let foot = |part: f64| {
            let p = ring + way * (part * (self.widen - 1.0) * joint.x + ROOT);
            DVec2::new(p.x.max(0.0), p.y)
        };
        // Walls of patches that are nearly level are in the solid sooner.
        let within = |p: &DVec2| self.is_solid([p.x / self.widen, p.x], p.y);
        let shorter = REACHES.into_iter().map(foot).find(within);
        shorter.unwrap_or_else(|| foot(1.0))
    }

    /// True if a ray may pass between the wall's foot and the surface beyond the joint, and then
    /// meet the cell: the wall comes from the cell's side of the joint's height, and its foot is
    /// not in the solid all round.
    fn is_open(&self, patch: &QuadricPatch, joint: DVec2, top: DVec2, foot: DVec2) -> bool {
        joint.x > 0.0
            && beside(patch, joint, top)
            // The wall is a cone of flat sides: its foot is between these two circles.
            && !self.is_solid([foot.x / self.widen, foot.x], foot.y)
    }

    /// True if everything between two radii is in the solid, at a height.
    fn is_solid(&self, radii: [f64; 2], z: f64) -> bool {
        let [inner, outer] = radii.map(|r| r * r);
        let mut beyond = 0;
        for patch in self.patches {
            if patch.z[0] <= z && z < patch.z[1] {
                let square = patch.square_at(z);
                if square > outer {
                    beyond += 1;
                } else if square >= inner {
                    return false;
                }
            }
        }
        beyond % 2 == 1
    }

    /// The feet of a wall that is level from the joint's height on. It passes the joint's circle
    /// itself, and no ray crosses a level twice.
    fn level_feet(&self, patch: &QuadricPatch, joint: DVec2) -> [DVec2; 2] {
        let wide = joint.x * self.widen;
        let radii = if patch.quadric[0] > 0.0 {
            [wide, (joint.x - ROOT).max(0.0)]
        } else {
            [joint.x, wide + ROOT]
        };
        radii.map(|r| DVec2::new(r, joint.y))
    }

    /// The feet of a wall at the end of a plane, whose rims are already beyond its circles. The
    /// wall is upright and continues behind the plane to the joint. Otherwise a ray from behind
    /// could pass between polygon and circle and meet the cell's other patches.
    fn feet_of_plane(&self, inner: DVec2, joint: DVec2, top: DVec2) -> [DVec2; 2] {
        let behind = joint.y + (joint.y - top.y).signum() * ROOT;
        let within = joint.x + (inner.x - joint.x).signum() * ROOT;
        [
            DVec2::new(top.x, behind),
            DVec2::new(within.max(0.0), behind),
        ]
    }
}

/// True if `top` is on the side of the joint's height on which the patch is.
fn beside(patch: &QuadricPatch, joint: DVec2, top: DVec2) -> bool {
    if joint.y > patch.start.y.min(patch.end.y) {
        top.y <= joint.y
    } else {
        top.y > joint.y
    }
}

/// Unit normal of a chord to its right: away from the solid.
fn outward(a: DVec2, b: DVec2) -> DVec2 {
    -(b - a).perp().normalize_or_zero()
}

/// The extreme heights of a span over the line through `a`, with their points: the ends and the
/// points at which the meridian `r = sqrt(p(z))` is parallel to the line: `p'^2 nr^2 = 4 nz^2 p`.
fn extremes(patch: &QuadricPatch, span: &Span, a: DVec2, normal: DVec2) -> Vec<(f64, DVec2)> {
    let height = |p: DVec2| (p - a).dot(normal);
    let mut found = vec![(height(span.from), span.from), (height(span.to), span.to)];
    if patch.is_plane() {
        return found;
    }
    let [side, k0, k1, k2] = patch.quadric;
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
            let p = DVec2::new(patch.square_at(z).max(0.0).sqrt(), z);
            found.push((height(p), p));
        }
    }
    found
}

/// Appends frusta and joins each to the one before it. Frusta at a bulge meet at the intersection
/// of their lines, and in a hollow where they cross. Otherwise more frusta join them. At a ridge
/// they go around its `rims`: a direct one has polygons around the circles of one part and within
/// those of the other, and would leave part of the joint's circle outside.
fn join(shell: &mut Vec<[DVec2; 2]>, frusta: &mut Vec<[DVec2; 2]>, mut rims: Option<[DVec2; 2]>) {
    for mut frustum in frusta.drain(..) {
        if let Some(last) = shell.last_mut() {
            let (p, q) = (last[1], frustum[0]);
            let (u, v) = (last[1] - last[0], frustum[1] - frustum[0]);
            let cross = u.perp_dot(v);
            let x = (frustum[0] - last[0]).perp_dot(v) / cross;
            let y = (frustum[0] - last[0]).perp_dot(u) / cross;
            let meeting = last[0] + u * x;
            let sharp = meeting.distance(p) + meeting.distance(q) > 3.0 * p.distance(q);
            let bulge = x >= 1.0 && y <= 0.0 && !sharp && meeting.x >= 0.0;
            let hollow = (0.0..=1.0).contains(&x) && (0.0..=1.0).contains(&y);
            if p.distance_squared(q) < 1e-16 {
                frustum[0] = p;
            } else if bulge || hollow {
                (last[1], frustum[0]) = (meeting, meeting);
            } else {
                let mut from = p;
                for to in around(p, rims, q) {
                    shell.push([from, to]);
                    from = to;
                }
            }
        }
        rims = None;
        shell.push(frustum);
    }
}

/// The points after `p` of the way to `q` that has the rims on its left.
fn around(p: DVec2, rims: Option<[DVec2; 2]>, q: DVec2) -> Vec<DVec2> {
    let outside = |from: DVec2, rim: DVec2, to: DVec2| (to - from).perp_dot(rim - from) < 0.0;
    let mut way = vec![q];
    if let Some([first, second]) = rims {
        if outside(p, second, q) {
            way.insert(0, second);
        }
        if outside(p, first, way[0]) {
            way.insert(0, first);
        }
        if way.len() == 2 && way[0] == first && outside(first, second, q) {
            way.insert(1, second);
        }
    }
    way
}
