//! The parts of a cavity that an eye may look into.
//!
//! # Tubes
//!
//! Consecutive patches of a chain with only empty space between them and the axis line a **tube**
//! `r < f(z)`. `f` may have any form, because level faces between the patches close its jumps. A
//! ray that is in the tube at two heights is therefore in it at all heights between, or it meets
//! the solid. A tube is closed at an end where its chain ends on the axis.
//!
//! # Hidden points
//!
//! Consider a ray from an eye outside the tube that first meets the solid at a point `p` of the
//! tube's lining. The ray was in the tube at all heights from `p` to the end by which it entered.
//! The entry end is open, and the eye is beyond it. In particular the ray passed the disc within
//! each **rim** `(r_o, z_o)` on its way. The eye at `(R, z_e)` projects such a disc onto the height
//! `z` of `p`. The projection's middle is at distance `R |z_o - z| / |z_e - z_o|` beyond the axis,
//! and its radius is `r_o |z_e - z| / |z_e - z_o|`. `p` is hidden if the circle of radius `r` at
//! that height is wholly outside the projection, or around it. The bounds are linear in `z`, so it
//! is enough to test a cell's ends.

use super::{QuadricPatch, extent};
use glam::DVec2;
use std::ops::Range;

/// Distance by which discs are widened, and points moved towards the visible side, object units.
const MARGIN: f64 = 1e-4;

#[derive(Clone, Debug, PartialEq)]
struct Tube {
    z: [f64; 2],
    r: f64,
    /// True if it ends on the axis, for its lower and its upper end.
    closed: [bool; 2],
    /// Ends of its patches.
    rims: Vec<DVec2>,
}

/// A cell within a tube's lining.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Place {
    tube: usize,
    z: [f64; 2],
    r: [f64; 2],
}

#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct CavityCulling {
    tubes: Vec<Tube>,
    /// One entry per cell; none outside of tubes.
    cells: Vec<Option<Place>>,
}

impl CavityCulling {
    /// Data of patches, which are in the order of their chains and divided into `cells`.
    pub fn new(patches: &[QuadricPatch], cells: &[Range<usize>]) -> Self {
        let mut sight = Self::default();
        let mut runs = Vec::new();
        let mut at = 0;
        while at < patches.len() {
            let run = run_from(patches, at);
            at = run.end.max(at + 1);
            if !run.is_empty() {
                sight.tubes.push(Tube::of(&patches[run.clone()]));
                runs.push(run);
            }
        }
        let place = |cell: &Range<usize>| {
            let within = |run: &Range<usize>| run.start <= cell.start && cell.end <= run.end;
            let tube = runs.iter().position(within)?;
            let [r, z] = extent(&patches[cell.clone()]);
            Some(Place { tube, z, r })
        };
        sight.cells = cells.iter().map(place).collect();
        sight
    }

    /// True if no ray from an eye at `(r, z)` can first meet the solid in a cell.
    pub fn hides(&self, cell: usize, eye: DVec2) -> bool {
        let Some(place) = self.cells[cell] else {
            return false;
        };
        let tube = &self.tubes[place.tube];
        let level = eye.y >= tube.z[0] - MARGIN && eye.y <= tube.z[1] + MARGIN;
        if level && eye.x <= tube.r + MARGIN {
            return false;
        }
        let from_above = !tube.closed[1] && eye.y > tube.z[1];
        let from_below = !tube.closed[0] && eye.y < tube.z[0];
        match (from_above, from_below) {
            (true, _) => tube.rims.iter().any(|rim| place.behind(*rim, eye, 1.0)),
            (_, true) => tube.rims.iter().any(|rim| place.behind(*rim, eye, -1.0)),
            _ => true,
        }
    }
}

impl Tube {
    fn of(lining: &[QuadricPatch]) -> Self {
        let [r, z] = extent(lining);
        let on_axis = |p: Option<DVec2>| p.is_some_and(|p| p.x == 0.0);
        let start = lining.first().map(|p| p.start);
        let end = lining.last().map(|p| p.end);
        Self {
            z,
            r: r[1],
            // The chain has the solid on its left, so it runs down the lining of a tube.
            closed: [on_axis(end), on_axis(start)],
            rims: start
                .into_iter()
                .chain(lining.iter().map(|p| p.end))
                .collect(),
        }
    }
}

impl Place {
    /// True if the disc within `rim` shows nothing of the cell to an eye above both (`up` 1) or
    /// below both (-1).
    fn behind(&self, rim: DVec2, eye: DVec2, up: f64) -> bool {
        let ends = [up * self.z[0], up * self.z[1]];
        let (z_o, z_e) = (up * rim.y, up * eye.y);
        let height = z_e - z_o;
        if height <= MARGIN || ends[0].max(ends[1]) > z_o {
            return false;
        }
        let bounds = ends.map(|z| {
            let middle = eye.x * (z_o - z) / height;
            let radius = (rim.x + MARGIN) * (z_e - z) / height;
            [middle - radius, middle + radius]
        });
        let beyond = self.r[1] + MARGIN < bounds[0][0].min(bounds[1][0]);
        let around = self.r[0] - MARGIN > bounds[0][1].max(bounds[1][1]);
        beyond || around
    }
}

/// The lining that begins at patch `at`; empty if none begins there.
fn run_from(patches: &[QuadricPatch], at: usize) -> Range<usize> {
    let chain = patches[at].chain;
    let joins = |p: &QuadricPatch| p.chain == chain && (p.is_plane() || is_exposed(patches, p));
    let end = at + patches[at..].iter().take_while(|p| joins(p)).count();
    let mut run = at..end;
    // A level face at an end belongs to the lining if it closes the tube.
    while run.start < run.end && patches[run.start].is_plane() && patches[run.start].start.x != 0.0
    {
        run.start += 1;
    }
    while run.start < run.end
        && patches[run.end - 1].is_plane()
        && patches[run.end - 1].end.x != 0.0
    {
        run.end -= 1;
    }
    let lines = patches[run.clone()].iter().any(|p| !p.is_plane());
    if lines { run } else { end..end }
}

/// True if no other patch is between a patch and the axis. Patches do not cross, so the nearer one
/// at one height is the nearer one at all common heights.
fn is_exposed(patches: &[QuadricPatch], patch: &QuadricPatch) -> bool {
    if patch.quadric[0] >= 0.0 {
        return false;
    }
    let nearer = |other: &QuadricPatch| {
        let (low, high) = (patch.z[0].max(other.z[0]), patch.z[1].min(other.z[1]));
        let middle = 0.5 * (low + high);
        high - low > 1e-9
            && !other.is_plane()
            && other.square_at(middle) < patch.square_at(middle) - 1e-12
    };
    !patches.iter().any(nearer)
}
