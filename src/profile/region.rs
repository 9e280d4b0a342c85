//! Regions of the plane on an integer grid, and the set operations between them.
//!
//! Coordinates are scaled by a power of two before they are rounded. Values such as 0, 1 and every
//! short binary fraction survive exactly. A region that is combined repeatedly is rounded only
//! once.

use super::Outline;
use glam::DVec2;
use i_overlay::core::fill_rule::FillRule as Filled;
use i_overlay::core::overlay::Overlay;
use i_overlay::core::overlay_rule::OverlayRule;
use i_overlay::i_float::int::point::IntPoint;
use std::collections::HashMap;

/// A closed contour on the integer grid.
type Contour = Vec<IntPoint<i32>>;

/// The points that self-crossing loops enclose.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FillRule {
    /// Winding number other than 0.
    NonZero,
    /// Winding number above 0: for loops that have the solid on their left.
    Positive,
    /// Odd winding number.
    EvenOdd,
}

impl FillRule {
    fn filled(self) -> Filled {
        match self {
            Self::NonZero => Filled::NonZero,
            Self::Positive => Filled::Positive,
            Self::EvenOdd => Filled::EvenOdd,
        }
    }
}

/// The scale between object units and the integer grid.
#[derive(Clone, Copy, Debug)]
pub struct Grid {
    scale: f64,
}

/// Integers stay below this in magnitude: half of what the overlay's arithmetic allows, so that
/// clipping and intersections have room.
const LIMIT: f64 = (1u32 << 29) as f64;

impl Grid {
    /// The finest grid on which coordinates of magnitude `extent` are safe.
    #[must_use]
    pub fn for_extent(extent: f64) -> Self {
        let exponent = (LIMIT / extent.max(1.0)).log2().floor();
        Self {
            scale: exponent.exp2(),
        }
    }

    /// The grid point nearest to `p`, in object units; a point too far out is moved to the grid's
    /// end.
    #[must_use]
    pub fn rounded(self, p: DVec2) -> DVec2 {
        self.place(self.snap(p))
    }

    /// Distance between neighbouring grid points, object units.
    #[must_use]
    pub fn step(self) -> f64 {
        1.0 / self.scale
    }

    fn snap(self, p: DVec2) -> IntPoint<i32> {
        let f = |v: f64| (v * self.scale).round().clamp(-LIMIT, LIMIT) as i32;
        IntPoint::new(f(p.x), f(p.y))
    }

    fn contours(self, loops: &[Vec<DVec2>]) -> Vec<Contour> {
        let snapped = |points: &Vec<DVec2>| points.iter().map(|&p| self.snap(p)).collect();
        loops.iter().map(snapped).collect()
    }

    /// The point of the plane that a grid point represents.
    fn place(self, p: IntPoint<i32>) -> DVec2 {
        DVec2::new(f64::from(p.x), f64::from(p.y)) / self.scale
    }
}

/// A region of the plane on a [`Grid`]. Regions that are combined must share one grid.
#[derive(Clone, Debug, Default)]
pub struct Region {
    /// Outer contours counter-clockwise, holes clockwise, none crossing.
    contours: Vec<Contour>,
}

impl Region {
    /// The region that closed loops enclose, self-crossing ones too.
    #[must_use]
    pub fn enclosed(grid: Grid, loops: &[Vec<DVec2>], rule: FillRule) -> Self {
        Self::resolved(&grid.contours(loops), rule)
    }

    /// Points in any of the regions. Merging many at once costs far less than one after the other.
    #[must_use]
    pub fn merged(regions: impl IntoIterator<Item = Self>) -> Self {
        let contours: Vec<Contour> = regions.into_iter().flat_map(|r| r.contours).collect();
        Self::resolved(&contours, FillRule::NonZero)
    }

    /// Points in both regions.
    #[must_use]
    pub fn intersection(&self, other: &Self) -> Self {
        self.combine(other, OverlayRule::Intersect)
    }

    /// Points in this region and not in the other.
    #[must_use]
    pub fn difference(&self, other: &Self) -> Self {
        self.combine(other, OverlayRule::Difference)
    }

    /// Points in either region.
    #[must_use]
    pub fn union(&self, other: &Self) -> Self {
        self.combine(other, OverlayRule::Union)
    }

    /// All points of a rectangle, corners rounded to the grid.
    #[must_use]
    pub fn rectangle(grid: Grid, low: DVec2, high: DVec2) -> Self {
        let (low, high) = (grid.snap(low), grid.snap(high));
        let corners = [
            low,
            IntPoint::new(high.x, low.y),
            high,
            IntPoint::new(low.x, high.y),
        ];
        Self {
            contours: vec![corners.to_vec()],
        }
    }

    /// The lowest and highest coordinates; `None` for a region without points.
    #[must_use]
    pub fn extent(&self, grid: Grid) -> Option<[DVec2; 2]> {
        let mut points = self.contours.iter().flatten();
        let &first = points.next()?;
        let (low, high) = points.fold((first, first), |(low, high), p| {
            (
                IntPoint::new(low.x.min(p.x), low.y.min(p.y)),
                IntPoint::new(high.x.max(p.x), high.y.max(p.y)),
            )
        });
        Some([grid.place(low), grid.place(high)])
    }

    /// Returns true if the region is one rectangle along the axes.
    #[must_use]
    pub fn is_rectangle(&self) -> bool {
        let [contour] = self.contours.as_slice() else {
            return false;
        };
        let along = |a: &IntPoint<i32>, b: &IntPoint<i32>| a.x == b.x || a.y == b.y;
        let next = contour.iter().cycle().skip(1);
        contour.len() == 4 && contour.iter().zip(next).all(|(a, b)| along(a, b))
    }

    /// Returns true for a region without points.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.contours.is_empty()
    }

    /// The region's boundary in object units.
    #[must_use]
    pub fn outline(&self, grid: Grid) -> Outline {
        self.placed(|p| grid.place(p))
    }

    fn placed(&self, place: impl Fn(IntPoint<i32>) -> DVec2) -> Outline {
        let placed = |c: &Contour| c.iter().map(|&p| place(p)).collect();
        Outline {
            loops: self.contours.iter().map(placed).collect(),
        }
    }

    fn resolved(contours: &[Contour], rule: FillRule) -> Self {
        let overlay = &mut Overlay::from_subj(contours);
        Self::collect(overlay, OverlayRule::Subject, rule)
    }

    fn combine(&self, other: &Self, rule: OverlayRule) -> Self {
        let overlay = &mut Overlay::from_subj_and_clip(&self.contours, &other.contours);
        Self::collect(overlay, rule, FillRule::NonZero)
    }

    fn collect(overlay: &mut Overlay<i32>, operation: OverlayRule, rule: FillRule) -> Self {
        let shapes = overlay.overlay(operation, rule.filled());
        Self {
            contours: shapes.into_iter().flatten().collect(),
        }
    }
}

impl Outline {
    /// The outline of the region that closed loops enclose, self-crossing ones too. Corners of the
    /// loops are returned exactly; only crossings are rounded, to a grid of about 1e-9.
    #[must_use]
    pub fn enclosed(loops: &[Vec<DVec2>], rule: FillRule) -> Self {
        let points = || loops.iter().flatten();
        let grid = Grid::for_extent(points().fold(0.0, |m: f64, p| m.max(p.abs().max_element())));
        let given: HashMap<_, _> = points().map(|&p| (grid.snap(p), p)).collect();
        Region::enclosed(grid, loops, rule)
            .placed(|p| given.get(&p).copied().unwrap_or_else(|| grid.place(p)))
    }
}
