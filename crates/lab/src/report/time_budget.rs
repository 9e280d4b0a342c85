//! How long a measurement may take, and how often frames are drawn in it.

use std::time::Duration;

/// How long and how often.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TimeBudget {
    /// The time that all is meant to take. The least number of rounds is drawn even if that takes
    /// longer, and of passes unless it takes half as long again: drivers that compile slowly get
    /// two.
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

/// Fewest passes of which intervals can be told.
const FEWEST: usize = 2;

impl TimeBudget {
    /// Whether another pass as long as the `last` would take too long after `gone`, however few the
    /// `passes` were. A number of passes that was asked for is kept.
    pub(super) fn would_overrun(&self, passes: usize, gone: Duration, last: Duration) -> bool {
        let asked_for = self.passes.0 == self.passes.1;
        !asked_for && passes >= FEWEST && gone + last > self.time.mul_f64(1.5)
    }

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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn slow_drivers_get_fewer_passes() {
        let seconds = Duration::from_secs;
        let over = |passes, gone, last| {
            TimeBudget::DEFAULT.would_overrun(passes, seconds(gone), seconds(last))
        };
        assert!(!over(1, 600, 600), "an interval takes two passes");
        assert!(over(2, 90, 45) && !over(2, 60, 45));
        assert!(!over(4, 80, 20) && over(4, 110, 20));
        let asked_for = TimeBudget {
            passes: (4, 4),
            ..TimeBudget::DEFAULT
        };
        assert!(!asked_for.would_overrun(2, seconds(600), seconds(600)));
    }
}
