//! How long a measurement may take, and how often frames are drawn in it.

use std::time::Duration;

/// How long and how often.
#[derive(Clone, Copy, Debug, PartialEq, serde::Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct TimeBudget {
    /// Seconds that all is meant to take. The least number of rounds is drawn even if that takes
    /// longer, and of passes unless that takes longer than the limit.
    pub seconds: f64,
    /// No pass begins that would end after so many seconds. Until then passes are added to
    /// pictures with a time that is not resolved. Not given: twice `seconds`.
    pub limit: Option<f64>,
    /// Least and most passes.
    pub passes: (usize, usize),
    /// Least and most rounds of a group in a pass.
    pub rounds: (usize, usize),
    /// Half the width of an interval, relative, below which no more samples are taken.
    pub precision: f64,
    /// Frames drawn before the first that counts: drivers compile at the first draw.
    pub warm_up: usize,
    /// Half the width of an interval, relative, above which a figure is not resolved.
    pub resolved: f64,
}

/// Fewest passes from which intervals follow.
const FEWEST: usize = 2;

impl Default for TimeBudget {
    /// A benchmark within two minutes.
    fn default() -> Self {
        Self {
            seconds: 85.0,
            limit: None,
            passes: (5, 10),
            rounds: (3, 20),
            precision: 0.01,
            warm_up: 1,
            resolved: 0.25,
        }
    }
}

impl TimeBudget {
    /// The time that all is meant to take.
    pub fn time(&self) -> Duration {
        Duration::try_from_secs_f64(self.seconds).unwrap_or(Duration::MAX)
    }

    /// The time beyond which no pass may end.
    pub fn limit(&self) -> Duration {
        let seconds = self.limit.unwrap_or(2.0 * self.seconds);
        Duration::try_from_secs_f64(seconds).unwrap_or(Duration::MAX)
    }

    /// True if the command line names the number of passes, which is then kept.
    pub(crate) fn is_fixed(&self) -> bool {
        self.passes.0 == self.passes.1
    }

    /// True if another pass as long as the `last` would end beyond the limit after `gone`.
    pub(crate) fn would_overrun(&self, passes: usize, gone: Duration, last: Duration) -> bool {
        !self.is_fixed() && passes >= FEWEST && gone + last > self.limit()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn slow_drivers_get_fewer_passes() {
        let seconds = Duration::from_secs;
        let over = |passes, gone, last| {
            TimeBudget::default().would_overrun(passes, seconds(gone), seconds(last))
        };
        assert!(!over(1, 600, 600), "an interval takes two passes");
        // The limit is 170 s.
        assert!(over(2, 130, 45) && !over(2, 100, 45));
        assert!(!over(4, 140, 20) && over(4, 160, 20));
        let fixed = TimeBudget {
            passes: (4, 4),
            ..TimeBudget::default()
        };
        assert!(!fixed.would_overrun(2, seconds(600), seconds(600)));
    }
}
