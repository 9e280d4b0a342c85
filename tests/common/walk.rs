//! CPU twins of shaders, in the same 32-bit steps: the search of [`Tables`]
//! (`shaders-glsl/include/search/quadric.glsl`), and the rasteriser and fragments of a
//! [`ProxyHull`].
//!
//! # The walk
//!
//! The ray is `o + t v`, about the axis. `z` is measured from the box's floor, and `t` from the
//! ray's entry into the box, so that coordinates are small. Let `a = vx^2 + vy^2`,
//! `b = ox vx + oy vy`, `c = ox^2 + oy^2`. Then `r^2(t) = c + t (2 b + t a)`, least at `-b / a`.
//! Rows are passed in the order of `t`.
//!
//! 1. Begin at the top level of the tree, in the row of the ray's first point.
//! 2. The node of that row at the present level ends at a row's border, which the ray crosses at
//!    `t_out`. The values of `r^2` between the present `t` and `t_out` go from `min` (at an end, or
//!    at `-b / a`) to `max` (at an end).
//! 3. If these overlap the node's extent, go down a level; in a row, try its patches.
//! 4. Otherwise, or after that, go on to the border: `t = t_out`, next row. Go up as many levels as
//!    the border's number of rows is divisible by 4. Stop if the ray leaves the box, or if the best
//!    hit so far is before `t`.
//!
//! A patch's root may be beyond the row in which it was tried. It is then stored as the best so
//! far, and rows up to the root are still walked.
//!
//! # The patch
//!
//! `G` along the ray is `al t^2 + 2 be t + ga`. `G` falls, from out to in, at one root only:
//! `t = (-be - s) / al`, `s^2 = be^2 - al ga`. This is `be <= 0 ? ga / (s - be) : -(be + s) / al`,
//! without cancellation or division by an `al` of zero (a plane with `be > 0` gives an infinity,
//! and no hit). A ray that starts inside the solid searches for the exit in the same way, with
//! `-G`.

use glam::{DVec2, DVec3, Vec3};
use revmap::surface::{Frustum, GpuPatch, ProxyHull, QuadricPatch, Tables};

/// Distance by which a hit may be before or behind the part of the ray within the box, in lengths
/// of 1: the rounding of `t`.
const SLACK: f32 = 4e-6;

/// A hit of ray and solid.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PatchHit {
    /// The point is `origin + t direction`.
    pub t: f64,
    /// Outward normal, not of unit length.
    pub normal: DVec3,
    /// The patch; `None` on a side face of the box.
    pub patch: Option<u32>,
}

/// The result of a walk.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Walk {
    /// First hit: `t` and the record.
    pub hit: Option<(f32, GpuPatch)>,
    /// Number of nodes visited.
    pub nodes: u32,
    /// Number of patches tried.
    pub patches: u32,
}

/// `a`, `b` and `c` of a ray.
fn coefficients(o: Vec3, v: Vec3) -> [f32; 3] {
    let square = |p: Vec3, q: Vec3| p.x * q.x + p.y * q.y;
    [square(v, v), square(o, v), square(o, o)]
}

/// The `t` of the root at which the ray goes from out to in of one quadric (`side` 1), or from in
/// to out (-1). NaN, or a number that fails the guard, if there is none. `(a, b, c)` as above.
pub fn entering_root(quadric: [f32; 4], side: f32, [a, b, c]: [f32; 3], [oz, vz]: [f32; 2]) -> f32 {
    let [ka, k0, k1, k2] = quadric;
    let al = side * (ka * a + k2 * vz * vz);
    let be = side * (ka * b + (0.5 * k1 + k2 * oz) * vz);
    let ga = side * (ka * c + (k0 + oz * (k1 + k2 * oz)));
    let s = (be * be - al * ga).sqrt();
    if be <= 0.0 {
        ga / (s - be)
    } else {
        -(be + s) / al
    }
}

/// The first hit of `o + t v` for `0 <= t <= end`, about the axis, `z` from the floor. `side` is 1
/// if the ray starts outside the solid, -1 if inside.
pub fn walk(tables: &Tables, o: Vec3, v: Vec3, end: f32, side: f32) -> Walk {
    let mut walk = Walk::default();
    let rows = tables.rows.len() as i32;
    if rows == 0 {
        return walk;
    }
    let n = rows as f32;
    let [a, b, c] = coefficients(o, v);
    let square = |t: f32| c + t * (2.0 * b + t * a);
    let nearest = -b / a.max(1e-30);
    let up = v.z >= 0.0;
    let per_z = 1.0 / if up { v.z.max(1e-20) } else { v.z.min(-1e-20) };
    let slack = SLACK / v.length();
    let top = tables.levels.len() as u32 - 1;
    let (mut level, mut t) = (top, 0.0f32);
    let mut best = f32::INFINITY;
    let mut row = ((o.z * n).floor() as i32).clamp(0, rows - 1);
    loop {
        let node = row >> (2 * level);
        let border = if up { node + 1 } else { node } << (2 * level);
        let out = ((border as f32 / n - o.z) * per_z).min(end).max(t);
        let least = square(nearest.clamp(t, out));
        let most = square(t).max(square(out));
        let [low, high] = tables.nodes[tables.levels[level as usize] as usize + node as usize];
        walk.nodes += 1;
        if most >= low && least <= high {
            if level > 0 {
                level -= 1;
                continue;
            }
            let run = tables.rows[row as usize];
            for k in run >> 12..(run >> 12) + (run & 0xfff) {
                let record = &tables.records[k as usize];
                walk.patches += 1;
                let [anchor, cr, from, to] = record.guard;
                let above = o.z - anchor;
                let root = entering_root(record.quadric, side, [a, b, c], [above, v.z]);
                let place = record.quadric[0].abs() * (above + root * v.z) + cr * square(root);
                let valid = place >= from && place <= to && root >= -slack;
                if valid && root < best && root <= end + slack {
                    best = root;
                    walk.hit = Some((root, *record));
                }
            }
        }
        if out >= end || best <= out {
            return walk;
        }
        t = out;
        row = if up { border } else { border - 1 };
        if row < 0 || row >= rows {
            return walk;
        }
        level = (border.trailing_zeros() / 2).min(top);
    }
}

/// Returns true if a point is in the solid: counts the patches beyond it, away from the axis.
pub fn contains(tables: &Tables, square: f32, z: f32) -> bool {
    let rows = tables.rows.len();
    if rows == 0 || !(0.0..=1.0).contains(&z) {
        return false;
    }
    let run = tables.rows[((z * rows as f32) as usize).min(rows - 1)];
    let beyond = (run >> 12..(run >> 12) + (run & 0xfff)).filter(|&k| {
        let record = tables.records[k as usize];
        let (range, [a, k0, k1, k2]) = (record.range, record.quadric);
        let above = z - record.guard[0];
        let p = -a * (k0 + above * (k1 + above * k2));
        a != 0.0 && range[0] <= z && z < range[1] && p > square
    });
    beyond.count() % 2 == 1
}

/// The first boundary point at `t >= 0` of a solid along `origin + t direction`, computed as in a
/// shader, in its precision. The solid is in its box `[-radius, radius]^2 x [0, 1]`, with its axis
/// at `axis` (object units, 0 in the middle).
///
/// The box's floor and ceiling are patches. A ray that enters the box through a side face inside
/// the solid hits that face. A ray that starts inside the solid and hits no patch hits the face
/// through which it leaves.
pub fn trace_patches(
    tables: &Tables,
    radius: f64,
    axis: DVec2,
    origin: DVec3,
    direction: DVec3,
) -> Option<PatchHit> {
    let low = DVec3::new(-radius, -radius, 0.0);
    let high = DVec3::new(radius, radius, 1.0);
    let mut t = [0.0, f64::INFINITY];
    let mut faces = [None, None];
    for k in 0..3 {
        if direction[k] == 0.0 {
            if origin[k] < low[k] || origin[k] > high[k] {
                return None;
            }
            continue;
        }
        let p = (low[k] - origin[k]) / direction[k];
        let q = (high[k] - origin[k]) / direction[k];
        if p.min(q) > t[0] {
            (t[0], faces[0]) = (p.min(q), Some(k));
        }
        if p.max(q) < t[1] {
            (t[1], faces[1]) = (p.max(q), Some(k));
        }
    }
    if t[1] <= t[0] {
        return None;
    }
    let start = origin + direction * t[0] - axis.extend(0.0);
    let (o, v) = (start.as_vec3(), direction.as_vec3());
    let face = |end: usize, side: f64| {
        faces[end].map(|k: usize| {
            let mut normal = DVec3::ZERO;
            normal[k] = side * direction[k].signum();
            PatchHit {
                t: t[end],
                normal,
                patch: None,
            }
        })
    };
    // A ray through floor or ceiling always comes from outside, since these are patches.
    let inside = faces[0] != Some(2) && contains(tables, o.x * o.x + o.y * o.y, o.z);
    if inside && faces[0].is_some() {
        return face(0, -1.0);
    }
    let side = if inside { -1.0 } else { 1.0 };
    let walk = walk(tables, o, v, (t[1] - t[0]) as f32, side);
    let Some((root, record)) = walk.hit else {
        return if inside { face(1, 1.0) } else { None };
    };
    let ([a, _, k1, k2], anchor) = (record.quadric, record.guard[0]);
    let p = o + v * root;
    Some(PatchHit {
        t: t[0] + f64::from(root),
        normal: Vec3::new(2.0 * a * p.x, 2.0 * a * p.y, k1 + 2.0 * k2 * (p.z - anchor)).as_dvec3(),
        patch: Some(record.range[2] as u32),
    })
}

/// Returns true if a point of the quadric belongs to the patch.
pub fn guards(patch: &QuadricPatch, square: f64, z: f64) -> bool {
    let [cz, cr, low, high] = patch.guard;
    (low..=high).contains(&(cz * z + cr * square))
}

/// Distance by which `z` of a hit may be below the floor or above the ceiling: more than rounding,
/// less than the resolution of guards.
const HEIGHT_SLACK: f32 = 1e-3;

/// The step of the azimuth and the ring of corner number `corner` (0 to `6 n - 1`) of the
/// triangles.
fn place(frustum: &Frustum, corner: u32) -> (u32, [f32; 2]) {
    let (side, which) = (corner / 6, corner % 6);
    let step = side + u32::from(matches!(which, 1 | 2 | 4));
    let begins = matches!(which, 0 | 1 | 3);
    (step, if begins { frustum.from } else { frustum.to })
}

/// The nearest fragment of a ray `o + t v` about the axis, from an eye outside, as rasteriser and
/// fragments compute it.
pub fn trace_hull(hull: &ProxyHull, records: &[GpuPatch], o: DVec3, v: DVec3) -> Walk {
    let mut walk = Walk::default();
    let circle: Vec<DVec2> = (0..=hull.sides)
        .map(|k| DVec2::from_angle(std::f64::consts::TAU * f64::from(k) / f64::from(hull.sides)))
        .collect();
    for frustum in &hull.frusta {
        for triangle in 0..2 * hull.sides {
            let corner = |k| {
                let (step, [r, z]) = place(frustum, 3 * triangle + k);
                (circle[step as usize] * f64::from(r)).extend(f64::from(z))
            };
            if !enters(o, v, [corner(0), corner(1), corner(2)]) {
                continue;
            }
            walk.nodes += 1;
            let cell = &records[frustum.first as usize..][..frustum.count as usize];
            for record in cell {
                walk.patches += 1;
                // The ray starts near the solid, as shaders start their rays at the box.
                let near = -o.dot(v) / v.length_squared();
                let (o, v) = ((o + v * near).as_vec3(), v.as_vec3());
                let flat = coefficients(o, v);
                let [anchor, cr, low, high] = record.guard;
                let above = o.z - anchor;
                let root = entering_root(record.quadric, 1.0, flat, [above, v.z]);
                let square = flat[2] + root * (2.0 * flat[1] + root * flat[0]);
                let z = o.z + root * v.z;
                let t = root + near as f32;
                let place = record.quadric[0].abs() * (above + root * v.z) + cr * square;
                let valid = (low..=high).contains(&place)
                    && (-HEIGHT_SLACK..=1.0 + HEIGHT_SLACK).contains(&z);
                if valid && walk.hit.is_none_or(|(best, _)| t < best) {
                    walk.hit = Some((t, *record));
                }
            }
        }
    }
    walk
}

/// Returns true if a ray passes a triangle against its normal.
fn enters(o: DVec3, v: DVec3, [a, b, c]: [DVec3; 3]) -> bool {
    let normal = (b - a).cross(c - a);
    if normal.dot(v) >= 0.0 || normal.dot(a - o) >= 0.0 {
        return false;
    }
    let side = |p: DVec3, q: DVec3| (q - o).cross(p - o).dot(v);
    let (x, y, z) = (side(a, b), side(b, c), side(c, a));
    x >= 0.0 && y >= 0.0 && z >= 0.0
}
