//! One way of drawing a picture that is made ready, and its times in a pass.

use super::TimedDraw;
use crate::measure::row::{Clocks, Sample};
use revmap::error::Result;
use revmap_figures::stats;

/// How often a pass of a picture is measured at most: again while the two clocks of any of its rows
/// disagree, as they do if another program gets the processor between them.
pub const TRIES: usize = 3;

/// A way of drawing, and its samples.
pub(super) struct Drawer {
    /// Its place among the plan's cases.
    pub(super) index: usize,
    draw: TimedDraw,
    samples: Vec<Sample>,
    /// Where those of the last try begin.
    begin: usize,
}

impl Drawer {
    pub(super) fn new(index: usize, draw: TimedDraw) -> Self {
        Self {
            index,
            draw,
            samples: Vec::new(),
            begin: 0,
        }
    }

    pub(super) fn draw(&mut self) -> Result<()> {
        self.samples.push((self.draw)()?);
        Ok(())
    }

    /// Begins another try.
    pub(super) fn begin_again(&mut self) {
        self.begin = self.samples.len();
    }

    fn of_try(&self) -> &[Sample] {
        &self.samples[self.begin..]
    }

    /// The samples of the last try; of the one before if the last was ended before its first frame.
    pub(super) fn last_try(mut self) -> Vec<Sample> {
        match self.of_try() {
            [] => self.samples,
            _ => self.samples.split_off(self.begin),
        }
    }

    /// True if the two clocks disagree in the last try.
    pub(super) fn is_disturbed(&self) -> bool {
        matches!(Clocks::of_frames(self.of_try()), Clocks::Disagree { .. })
    }

    /// True if the median is known to within `precision`, by the samples' median deviation.
    pub(super) fn is_settled(&self, precision: f64) -> bool {
        let times: Vec<f64> = self.of_try().iter().map(|s| s.frame_ms).collect();
        let Some(middle) = stats::median(&times) else {
            return false;
        };
        let off: Vec<f64> = times.iter().map(|t| (t - middle).abs()).collect();
        // A normal distribution's median errs by 1.25 sigma / sqrt n, sigma is 1.48 median deviations.
        let deviation = stats::median(&off).unwrap_or(0.0);
        let error = 1.25 * 1.48 * deviation / (times.len() as f64).sqrt();
        times.len() >= 5 && 1.96 * error <= precision * middle
    }
}
