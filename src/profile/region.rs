//! Regions of the plane on an integer grid, and the set operations between them.
//!
//! Coordinates are scaled by a power of two before they are rounded. Values such as 0, 1 and every
//! short binary fraction survive exactly. A region that is combined repeatedly is rounded only
//! once.

use super::Outline;
use glam::DVec2;
use i_overlay::core::fill_rule::FillRule;
use i_overlay::core::overlay::Overlay;
use i_overlay::core::overlay_rule::OverlayRule;
use i_overlay::i_float::int::point::IntPoint;
use std::collections::HashMap;

/// A closed contour on the integer grid.
pub(super) type Contour = Vec<IntPoint<i32>>;

/// The points that a self-crossing contour encloses.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Rule {
    /// Winding number other than 0.
    NonZero,
    /// Winding number above 0: for loops that have the solid on their left.
    Positive,
    /// Odd winding number.
    #[cfg(feature = "drawing")]
    EvenOdd,
}

impl Rule {
    fn fill(self) -> FillRule {
        match self {
            Self::NonZero => FillRule::NonZero,
            Self::Positive => FillRule::Positive,
            #[cfg(feature = "drawing")]
            Self::EvenOdd => FillRule::EvenOdd,
        }
    }
}

/// The scale between object units and the integer grid.
#[derive(Clone, Copy, Debug)]
pub(super) struct Grid {
    scale: f64,
}

/// Integers stay below this in magnitude: half of what the overlay's arithmetic allows, so that
/// clipping and intersections have room.
const LIMIT: f64 = (1u32 << 29) as f64;

impl Grid {
    /// The finest grid on which coordinates of magnitude `extent` are safe.
    pub fn for_extent(extent: f64) -> Self {
        let exponent = (LIMIT / extent.max(1.0)).log2().floor();
        Self {
            scale: exponent.exp2(),
        }
    }

    /// Rounds a point to the grid; a point too far out is moved to the grid's end.
    pub fn snap(self, p: DVec2) -> IntPoint<i32> {
        let f = |v: f64| (v * self.scale).round().clamp(-LIMIT, LIMIT) as i32;
        IntPoint::new(f(p.x), f(p.y))
    }

    /// The point of the plane that a grid point represents.
    pub fn place(self, p: IntPoint<i32>) -> DVec2 {
        DVec2::new(f64::from(p.x), f64::from(p.y)) / self.scale
    }
}

/// A region of the plane: outer contours counter-clockwise, holes clockwise, none crossing.
#[derive(Clone, Debug, Default)]
pub(super) struct Region {
    pub contours: Vec<Contour>,
}

impl Region {
    /// The region that closed contours enclose, self-crossing ones too.
    pub fn enclosed(contours: &[Contour], rule: Rule) -> Self {
        Self::collect(
            &mut Overlay::from_subj(contours),
            OverlayRule::Subject,
            rule,
        )
    }

    /// Points in both regions.
    #[cfg(feature = "drawing")]
    pub fn intersection(&self, other: &Self) -> Self {
        self.combine(other, OverlayRule::Intersect)
    }

    /// Points in this region and not in the other.
    #[cfg(feature = "drawing")]
    pub fn difference(&self, other: &Self) -> Self {
        self.combine(other, OverlayRule::Difference)
    }

    /// Points in either region.
    #[cfg(feature = "drawing")]
    pub fn union(&self, other: &Self) -> Self {
        self.combine(other, OverlayRule::Union)
    }

    /// Returns true for a region without points.
    #[cfg(feature = "drawing")]
    pub fn is_empty(&self) -> bool {
        self.contours.is_empty()
    }

    #[cfg(feature = "drawing")]
    fn combine(&self, other: &Self, rule: OverlayRule) -> Self {
        let mut overlay = Overlay::from_subj_and_clip(&self.contours, &other.contours);
        Self::collect(&mut overlay, rule, Rule::NonZero)
    }

    fn collect(overlay: &mut Overlay<i32>, operation: OverlayRule, rule: Rule) -> Self {
        Self {
            contours: overlay
                .overlay(operation, rule.fill())
                .into_iter()
                .flatten()
                .collect(),
        }
    }

    /// The region's boundary in object units; `place` maps grid points to the plane.
    pub fn outline(&self, place: impl Fn(IntPoint<i32>) -> DVec2) -> Outline {
        Outline {
            loops: self
                .contours
                .iter()
                .map(|c| c.iter().map(|&p| place(p)).collect())
                .collect(),
        }
    }
}

/// The outline of the region that closed loops enclose, self-crossing ones too. Input corners are
/// returned exactly; only crossings are rounded to the grid.
pub(super) fn enclosed(loops: &[Vec<DVec2>], rule: Rule) -> Outline {
    let points = || loops.iter().flatten();
    let grid = Grid::for_extent(points().fold(0.0, |m: f64, p| m.max(p.abs().max_element())));
    let given: HashMap<_, _> = points().map(|&p| (grid.snap(p), p)).collect();
    let contours: Vec<Contour> = loops
        .iter()
        .map(|points| points.iter().map(|&p| grid.snap(p)).collect())
        .collect();
    Region::enclosed(&contours, rule)
        .outline(|p| given.get(&p).copied().unwrap_or_else(|| grid.place(p)))
}
