//! The contour `F = d - w = 0` of an outline within the box, as chains that keep every corner.

use super::Offset;
use super::chain::{Chain, Segments};
use super::offset::{Corner, Layer, trim};
use super::tree::Tree;
use crate::error::{Error, ErrorKind, Result};
use crate::profile::{Outline, Segment};
use glam::DVec2;

/// The boundary of the half-plane's solid within `0 <= z <= 1`: its turned surface, and its
/// sections with the box's floor and ceiling.
///
/// The side faces of the box are not part of it, because they are not surfaces of revolution. The
/// drawing code clips the ray there.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Contour {
    /// Curves that do not cross, solid on the left.
    pub chains: Vec<Chain>,
}

/// The data of an outline that does not depend on the offset, prepared once.
#[derive(Clone, Debug)]
pub struct ContourSource {
    /// The surface: all segments except those on the axis, each loop in its order.
    segments: Vec<Segment>,
    /// The corner before each segment, if a curve begins there on the axis, and the corner after
    /// it.
    corners: Vec<[Option<Corner>; 2]>,
    tree: Tree,
}

/// Upper limit on segments of an outline. Time and memory grow with their number.
pub const MOST_SEGMENTS: usize = 1 << 20;

/// A point within this distance of the box's floor or ceiling counts as on it.
const FACE: f64 = 1e-9;

impl ContourSource {
    /// Prepares an outline.
    ///
    /// # Errors
    /// [`ErrorKind::Content`] if no part of it is off the axis, or a point is not finite;
    /// [`ErrorKind::TooLarge`] for more than [`MOST_SEGMENTS`] segments off the axis.
    pub fn new(outline: &Outline) -> Result<Self> {
        let snap = |p: DVec2| {
            let near = |v: f64| {
                let face = v.round();
                let on_face = (face == 0.0 || face == 1.0) && (v - face).abs() < FACE;
                if on_face { face } else { v }
            };
            DVec2::new(if p.x < FACE { 0.0 } else { p.x }, near(p.y))
        };
        let mut segments = Vec::new();
        let mut corners = Vec::new();
        for points in &outline.loops {
            let first = segments.len();
            for (k, &a) in points.iter().enumerate() {
                let (a, b) = (snap(a), snap(points[(k + 1) % points.len()]));
                if a.x.max(b.x) > 0.0 && a != b {
                    segments.push(Segment { a, b });
                }
            }
            corners_of(&segments[first..], &mut corners);
        }
        if segments.len() > MOST_SEGMENTS {
            let message = format!(
                "the outline has {} segments; at most {MOST_SEGMENTS} are drawn: blur the picture (profile_smooth) or leave points out",
                segments.len()
            );
            return Err(Error::new(ErrorKind::TooLarge, message));
        }
        if !segments.iter().all(|s| s.a.is_finite() && s.b.is_finite()) {
            return fault("a point of the outline is not finite; give numbers");
        }
        if segments.is_empty() {
            return fault("the profile has no surface; give one with a solid part off the axis");
        }
        let tree = Tree::new(&segments);
        Ok(Self {
            segments,
            corners,
            tree,
        })
    }

    /// The contour of the profile under an offset. The contour has no chain if no part of the solid
    /// is left within the box.
    ///
    /// # Errors
    /// [`ErrorKind::Content`] if the contour cannot be closed: loops that cross, or numbers that
    /// are not finite.
    pub fn contour(&self, offset: &Offset) -> Result<Contour> {
        let Offset {
            extend,
            bevel,
            chamfer,
        } = *offset;
        let plain = extend == 0.0 && (bevel == 0.0 || chamfer <= 0.0);
        // Curves that touch without crossing may not close at the exact offset. An offset that is
        // wrong by a few ten-thousandths of a texel is good enough.
        let trials = [0.0, 1e-7, -1e-7, 3e-7, -3e-7, 1e-6, -1e-6];
        let finite = extend.is_finite() && bevel.is_finite() && chamfer.is_finite();
        let found = if plain {
            close(self.plain())
        } else {
            trials.iter().filter(|_| finite).find_map(|shift| {
                close(self.moved(&Offset {
                    extend: extend + shift,
                    ..*offset
                }))
            })
        };
        match found {
            Some(chains) => Ok(Contour { chains }),
            None => fault(
                "the contour does not close; give loops that do not cross, and finite offsets",
            ),
        }
    }

    fn plain(&self) -> Segments {
        let mut parts = Segments::default();
        for s in &self.segments {
            if let Some([a, b]) = clipped(s) {
                parts.line(a, b);
            }
        }
        parts
    }

    fn moved(&self, offset: &Offset) -> Segments {
        let mut parts = Segments::default();
        let size = (self.segments.iter()).fold(1.0f64, |size, s| size.max(s.a.x).max(s.b.x));
        let mut layer = |alpha, beta, low, high| {
            let layer = Layer {
                tree: &self.tree,
                alpha,
                beta,
                low,
                high,
                size,
            };
            if high > low {
                trim(&layer, &self.segments, &self.corners, &mut parts);
            }
        };
        let (e, b) = (offset.extend, offset.bevel);
        let c = if b == 0.0 {
            0.0
        } else {
            offset.chamfer.clamp(0.0, 1.0)
        };
        layer(e + b * c, 0.0, 0.0, 1.0 - c);
        layer(e + b, -b, 1.0 - c, 1.0);
        parts
    }
}

fn fault<T>(message: &str) -> Result<T> {
    Err(Error::new(ErrorKind::Content, message))
}

fn close(mut parts: Segments) -> Option<Vec<Chain>> {
    faces(&mut parts)?;
    parts.join()
}

fn corners_of(segments: &[Segment], corners: &mut Vec<[Option<Corner>; 2]>) {
    let n = segments.len();
    let normal = |s: &Segment| -(s.b - s.a).perp().normalize_or_zero();
    for (k, s) in segments.iter().enumerate() {
        let (previous, next) = (&segments[(k + n - 1) % n], &segments[(k + 1) % n]);
        let own = normal(s);
        // The mirrored half continues on the axis, and the axis itself is between the two halves.
        let axis = DVec2::new(0.0, own.y.signum());
        // A solid, or a cavity, that touches the axis in a point is all on one side of it. No curve
        // within that wedge is about the point, so only the other side has a corner.
        let wedge = |p: &Segment, q: &Segment| match p.b == q.a {
            true => (p.b - p.a).perp_dot(q.b - q.a),
            false => 0.0,
        };
        let shown = |c: &Corner, wedge: f64| c.turn * wedge >= 0.0;
        let before = (previous.b != s.a || s.a.x == 0.0)
            .then(|| corner(s.a, axis, own).filter(|c| shown(c, wedge(previous, s))));
        let after = if next.a != s.b || s.b.x == 0.0 {
            corner(s.b, own, axis).filter(|c| shown(c, wedge(s, next)))
        } else {
            corner(s.b, own, normal(next))
        };
        corners.push([before.flatten(), after]);
    }
}

fn corner(point: DVec2, before: DVec2, after: DVec2) -> Option<Corner> {
    let turn = before.perp_dot(after).atan2(before.dot(after));
    (turn.abs() > 1e-12).then(|| Corner {
        point,
        angle: before.y.atan2(before.x),
        turn,
    })
}

/// The part of a segment between floor and ceiling. Returns none if the segment is in one of them,
/// where the face is made anew.
fn clipped(s: &Segment) -> Option<[DVec2; 2]> {
    let (low, high) = (s.a.y.min(s.b.y), s.a.y.max(s.b.y));
    if high <= 0.0 || low >= 1.0 {
        return None;
    }
    let at = |z: f64| {
        let r = s.a.x + (s.b.x - s.a.x) * ((z - s.a.y) / (s.b.y - s.a.y));
        DVec2::new(r, z)
    };
    let end = |p: DVec2| match p.y {
        ..0.0 => at(0.0),
        y if y > 1.0 => at(1.0),
        _ => p,
    };
    Some([end(s.a), end(s.b)])
}

/// Closes the solid by the box's floor and ceiling.
///
/// Seen from the axis, the solid begins where a part ends on the floor, and it ends where a part
/// starts there. The ceiling has the opposite order. A count from the axis outwards gives the solid
/// ranges of the face. Returns `None` if the count is inconsistent.
fn faces(parts: &mut Segments) -> Option<()> {
    for face in [0.0, 1.0] {
        // Changes of the count, seen from the axis.
        let mut events: Vec<(f64, i32)> = Vec::new();
        for k in 0..parts.len() {
            let [start, end] = parts.ends(k);
            let sign = if face == 0.0 { 1 } else { -1 };
            if start.y == face {
                events.push((start.x, -sign));
            }
            if end.y == face {
                events.push((end.x, sign));
            }
        }
        events.sort_unstable_by(|p, q| p.0.total_cmp(&q.0).then(p.1.cmp(&q.1)));
        let mut depth = -events.iter().map(|e| e.1).sum::<i32>();
        let mut from = 0.0;
        let mut k = 0;
        while k < events.len() {
            let r = events[k].0;
            let before = depth;
            while k < events.len() && events[k].0 - r < super::chain::JOINT {
                depth += events[k].1;
                k += 1;
            }
            match (before, depth) {
                (0, 1) => from = r,
                (1, 0) => {
                    let (a, b) = (DVec2::new(from, face), DVec2::new(r, face));
                    if r > from {
                        if face == 0.0 {
                            parts.line(a, b);
                        } else {
                            parts.line(b, a);
                        }
                    }
                }
                (0, 0) | (1, 1) => {}
                _ => return None,
            }
        }
        if depth != 0 {
            return None;
        }
    }
    Some(())
}
