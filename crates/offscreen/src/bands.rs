//! Frames in several submissions, because systems reset a device whose submission takes seconds.

use revmap::gpu::View;
use std::ops::Range;

/// Most milliseconds of a submission on a GPU. Windows resets a device after 2 s.
const MOST_MS: f64 = 500.0;

/// Most rays of a submission while the time of a frame is unknown: rows that were not drawn may take
/// longer than those that were.
const FIRST_RAYS: u32 = 1 << 20;

/// Divides frames into bands of rows, by the time that rows took.
pub(crate) struct Bands {
    /// Most milliseconds of a submission; infinite without a limit.
    most_ms: f64,
    /// Rays of a pixel.
    samples: u32,
    /// Milliseconds of the slowest row of the last frame.
    last_frame: Option<f64>,
    /// Milliseconds of the slowest row of this frame so far.
    this_frame: f64,
}

impl Bands {
    /// `most_ms`: most milliseconds of a submission; none for the default, which is no limit on a
    /// CPU.
    pub fn new(most_ms: Option<f64>, is_cpu: bool, samples: u32) -> Self {
        let default = if is_cpu { f64::INFINITY } else { MOST_MS };
        Self {
            most_ms: most_ms.unwrap_or(default),
            samples,
            last_frame: None,
            this_frame: 0.0,
        }
    }

    /// Drops the times of frames, because other content is drawn.
    pub fn forget(&mut self) {
        (self.last_frame, self.this_frame) = (None, 0.0);
    }

    /// The rows of a frame's next submission, from row `first` on.
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // `as` saturates
    pub fn next(&mut self, first: u32, [width, height]: [u32; 2]) -> Range<u32> {
        if first == 0 {
            self.this_frame = 0.0; // of a frame that failed
        }
        let rays = width.saturating_mul(self.samples).max(1);
        // Half of the time, as other rows or frames may take longer.
        let in_time = |row_ms: f64| (0.5 * self.most_ms / row_ms.max(1e-9)) as u32;
        let rows = match self.last_frame {
            _ if self.most_ms == f64::INFINITY => u32::MAX,
            Some(row_ms) => in_time(row_ms.max(self.this_frame)),
            None => in_time(self.this_frame).min(FIRST_RAYS / rays),
        };
        let end = match rows >= height - first {
            true => height,
            false => first + (rows / View::ROW_STEP).max(1) * View::ROW_STEP,
        };
        first..end.min(height)
    }

    /// Takes the time of a submission of so many rows. `ends`: it ends the frame.
    pub fn record(&mut self, rows: &Range<u32>, ms: f64, ends: bool) {
        let row_ms = ms / f64::from((rows.end - rows.start).max(1));
        self.this_frame = self.this_frame.max(row_ms);
        if ends {
            self.last_frame = Some(std::mem::take(&mut self.this_frame));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Draws a frame whose row `y` takes `row_ms(y)`. Returns the time of each submission.
    fn frame(bands: &mut Bands, size: [u32; 2], row_ms: impl Fn(u32) -> f64) -> Vec<f64> {
        let (mut row, mut times) = (0, Vec::new());
        while row < size[1] {
            let rows = bands.next(row, size);
            assert!(rows.start == row && rows.end > row && rows.end <= size[1]);
            assert!(rows.end.is_multiple_of(View::ROW_STEP) || rows.end == size[1]);
            let ms: f64 = rows.clone().map(&row_ms).sum();
            row = rows.end;
            bands.record(&rows, ms, row == size[1]);
            times.push(ms);
        }
        times
    }

    #[test]
    fn submissions_stay_below_the_limit() {
        let size = [4000, 3000];
        let mut bands = Bands::new(None, false, 1);
        // Sky above, then rows that take 7 ms: 14 s in all.
        let row_ms = |y: u32| if y < 1000 { 0.01 } else { 7.0 };
        let first = frame(&mut bands, size, row_ms);
        let second = frame(&mut bands, size, row_ms);
        assert!(second.iter().all(|ms| *ms <= MOST_MS), "{second:?}");
        // The first slow band of a first frame is as large as one of fast rows.
        let long = first.iter().filter(|ms| **ms > MOST_MS).count();
        assert!(long <= 1 && first.len() > 10, "{first:?}");
        bands.forget();
        assert_eq!(frame(&mut bands, size, row_ms), first);
        // Eight rays a pixel are as many as eight times the pixels.
        let mut samples = Bands::new(None, false, 8);
        assert_eq!(samples.next(0, size), 0..32);
        // A frame that became fast is one submission after the next.
        frame(&mut bands, size, |_| 0.01);
        assert_eq!(frame(&mut bands, [4000, 3001], |_| 0.01).len(), 1);
    }

    #[test]
    fn frames_of_a_cpu_are_whole() {
        let mut bands = Bands::new(None, true, 1);
        assert_eq!(frame(&mut bands, [4000, 3001], |_| 7.0).len(), 1);
        let mut bands = Bands::new(Some(100.0), true, 1);
        assert!(frame(&mut bands, [4000, 3000], |_| 7.0).len() > 1);
    }
}
