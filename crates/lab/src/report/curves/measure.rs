//! The errors that charts of error against time can show.

use crate::report::chart::axis::Axis;
use crate::report::ratios::LEAST_DEPTH;
use crate::report::row::Row;

/// An error that a chart can show.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Measure {
    /// 99th percentile of the depth error, texels.
    Depth,
    /// Missed and ghost pixels, percent of the pixels hit.
    Wrong,
    /// Root mean square of the normals' angle, degrees.
    Normal,
    /// Mean of FLIP.
    Flip,
}

impl Measure {
    /// All, in the order of a page.
    pub const ALL: [Self; 4] = [Self::Depth, Self::Wrong, Self::Normal, Self::Flip];

    /// Of a row; `None` where nothing was hit in both pictures.
    #[must_use]
    pub fn of(self, row: &Row) -> Option<f64> {
        match self {
            Self::Depth => row.errors.depth.map(|d| d.p99),
            Self::Wrong => Some(100.0 * row.errors.wrong()),
            Self::Normal => row.errors.normal.map(|n| n.rms),
            Self::Flip => row.errors.flip,
        }
    }

    /// Its axis. What lies below the floor is of no use to tell apart.
    #[must_use]
    pub fn axis(self) -> Axis {
        match self {
            Self::Depth => Axis::log("depth error, p99 (h/512)").from(LEAST_DEPTH),
            Self::Wrong => Axis::log("wrong pixels (% of pixels hit)").from(1e-4),
            Self::Normal => Axis::log("error of normals, rms (degrees)").from(1e-3),
            Self::Flip => Axis::log("FLIP, mean over the picture").from(1e-6),
        }
    }

    /// Its name in titles and files.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Depth => "depth error",
            Self::Wrong => "wrong pixels",
            Self::Normal => "error of normals",
            Self::Flip => "FLIP",
        }
    }
}
