//! How long a measurement may take, and how often frames are drawn in it.

use std::time::Duration;

/// How long and how often.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Limits {
    /// The time that all is meant to take. The least number of rounds is drawn even if that takes longer.
    pub time: Duration,
    /// Least and most passes.
    pub passes: (usize, usize),
    /// Least and most rounds of a group in a pass.
    pub rounds: (usize, usize),
    /// Half the width of an interval, relative, below which no more samples are taken.
    pub precision: f64,
    /// Frames drawn before the first that counts: drivers compile at the first draw.
    pub warm_up: usize,
}

impl Limits {
    /// The default: within two minutes.
    pub const DEFAULT: Self = Self {
        time: Duration::from_secs(85),
        passes: (5, 10),
        rounds: (3, 20),
        precision: 0.01,
        warm_up: 1,
    };
    /// A look: within 20 seconds.
    pub const QUICK: Self = Self {
        time: Duration::from_secs(11),
        passes: (4, 8),
        rounds: (2, 5),
        ..Self::DEFAULT
    };
    /// A chart of many ways of drawing: few samples of each.
    pub const CHART: Self = Self {
        time: Duration::from_secs(600),
        passes: (4, 6),
        rounds: (2, 5),
        ..Self::DEFAULT
    };
    /// The whole sweep: as long as it takes to know.
    pub const FULL: Self = Self {
        time: Duration::from_secs(1500),
        passes: (5, 12),
        rounds: (3, 20),
        ..Self::DEFAULT
    };
}
