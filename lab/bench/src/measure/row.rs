//! One measurement with all that was found out about it.

use crate::plan::Case;
use crate::plan::method::{Method, MethodSettings};
use crate::plan::view::{Framing, View};
use revmap::frame::Frame;
use revmap::maps::MapSource;
use revmap::scene::{Offset, Shadow};
use revmap_compare::{Comparison, PixelErrors};
use revmap_figures::groups::one;
use revmap_figures::stats::{self, Interval};

/// How far the device's clock and the wall clock may be apart, relative to the wall clock.
pub const CLOCKS_APART: f64 = 0.15;

/// How much longer the wall clock may be in addition, ms: it includes submission and completion.
/// These take 0.05 to 0.1 ms on an NVIDIA H100, which draws a solid in 0.07 ms.
pub const SUBMISSION_MS: f64 = 0.15;

/// The times of one frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sample {
    /// Milliseconds between the device's own timestamps; `None` where it has none.
    pub gpu_ms: Option<f64>,
    /// Milliseconds by the wall clock, without reading back.
    pub frame_ms: f64,
    /// Milliseconds that the host took before, to apply a change and to record; `None` where nothing
    /// changes.
    pub change_ms: Option<f64>,
}

impl Sample {
    /// Its time: by the device's clock where there is one, else by the wall clock.
    pub fn ms(&self) -> f64 {
        self.gpu_ms.unwrap_or(self.frame_ms)
    }
}

/// Look-ups over the pixels in which the search ran.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Steps {
    /// Mean.
    pub mean: f64,
    /// 99th percentile (nearest rank).
    pub p99: f64,
    /// Most.
    pub max: f64,
    /// Pixels in which a search ran out of steps.
    pub exhausted: usize,
}

impl Steps {
    /// Look-ups of a frame, over the pixels with any: others are not covered by a box.
    pub fn of(frame: &Frame) -> Self {
        let looked = frame.steps.iter().filter(|s| **s > 0.0);
        let steps: Vec<f64> = looked.map(|s| f64::from(*s)).collect();
        Self {
            mean: steps.iter().sum::<f64>() / steps.len().max(1) as f64,
            p99: stats::quantile(&steps, 0.99).unwrap_or(0.0),
            max: steps.iter().copied().fold(0.0, f64::max),
            exhausted: frame.exhausted,
        }
    }
}

/// Agreement of the two clocks.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Clocks {
    /// They agree.
    Agree,
    /// The device has no clock of its own; the wall clock stands alone.
    Wall,
    /// They are further apart than [`CLOCKS_APART`] plus [`SUBMISSION_MS`]: the row counts in no
    /// summary.
    Disagree {
        /// Median of the device's clock, ms.
        gpu_ms: f64,
        /// Median of the wall clock, ms.
        frame_ms: f64,
    },
}

impl Clocks {
    /// The agreement of what they show for one frame, ms.
    fn of(gpu_ms: Option<f64>, frame_ms: Option<f64>) -> Self {
        let Some(gpu_ms) = gpu_ms else {
            return Self::Wall;
        };
        let frame_ms = frame_ms.unwrap_or(0.0);
        let longer = (frame_ms - gpu_ms).clamp(0.0, SUBMISSION_MS);
        if (gpu_ms + longer - frame_ms).abs() <= CLOCKS_APART * frame_ms {
            Self::Agree
        } else {
            Self::Disagree { gpu_ms, frame_ms }
        }
    }

    /// The agreement of the medians of some frames.
    pub(crate) fn of_frames(samples: &[Sample]) -> Self {
        let gpu_ms: Vec<f64> = samples.iter().filter_map(|s| s.gpu_ms).collect();
        let frame_ms: Vec<f64> = samples.iter().map(|s| s.frame_ms).collect();
        Self::of(stats::median(&gpu_ms), stats::median(&frame_ms))
    }
}

/// One measurement.
#[derive(Clone, Debug, PartialEq)]
pub struct Row {
    /// Index of the view in the plan.
    pub view: usize,
    /// The view's name.
    pub scene: String,
    /// How much of the picture its solids take.
    pub framing: Framing,
    /// Form of the offset.
    pub technique: &'static str,
    /// The offset, where all objects have the same.
    pub offset: Option<Offset>,
    /// How it was drawn.
    pub settings: MethodSettings,
    /// Rows of the maps, where all objects have the same.
    pub map_rows: Option<u32>,
    /// Source of the distances, where all objects have the same.
    pub source: Option<MapSource>,
    /// Shadows in the scene.
    pub shadow: Shadow,
    /// Solids in the scene, copies counted.
    pub solids: usize,
    /// The entries of the plan that it belongs to, as [`Case::sweeps`].
    pub sweeps: u64,
    /// The parameter of its view, in plans that vary one.
    pub value: Option<f64>,
    /// How far the picture is from the truth.
    pub errors: Comparison,
    /// The same in pixels, in plans that want it.
    pub pixel_errors: Option<PixelErrors>,
    /// FLIP against a picture of many rays by the same method, in plans that compare with one.
    pub flip_own: Option<f64>,
    /// Look-ups.
    pub steps: Steps,
    /// Bytes of maps on the device.
    pub map_bytes: u64,
    /// Times of frames, in the passes and rounds in which they were drawn.
    pub passes: Vec<Vec<Sample>>,
}

impl Row {
    /// The tolerance that the row was drawn to, pixels.
    pub fn tolerance_px(&self) -> Option<f64> {
        let settings = &self.settings;
        let own = settings.method.follows_tolerance();
        let own = own.then(|| settings.tolerance.pixels());
        own.or(settings.method.pixels())
    }

    /// A row of which the accuracy is known, and no time yet.
    pub fn new(view: &View, case: &Case, errors: Comparison, steps: Steps, map_bytes: u64) -> Self {
        let objects = &view.scene.objects;
        let settings = case.settings;
        let searched = !settings.method.is_mesh();
        let own = || one(objects.iter().map(|o| o.map_rows));
        let rows = settings.map_rows.or_else(own);
        Self {
            view: case.view,
            scene: view.name.clone(),
            framing: view.framing,
            technique: view.technique(),
            offset: view.offset(),
            settings,
            map_rows: rows.filter(|_| searched),
            source: searched.then(|| settings.map_source.unwrap_or_default()),
            shadow: view.scene.shadow,
            solids: view.solids(),
            sweeps: case.sweeps,
            value: view.value,
            errors,
            pixel_errors: None,
            flip_own: None,
            steps,
            map_bytes,
            passes: Vec::new(),
        }
    }

    /// The picture that it shows: a view at a size.
    pub fn picture(&self) -> (usize, u32, u32) {
        (self.view, self.settings.width, self.settings.height)
    }

    /// The share of the picture's pixels in which the reference hits, 0 to 1.
    pub fn covered(&self) -> f64 {
        self.errors.hits as f64 / self.errors.pixels.max(1) as f64
    }

    /// Pixels across and down, as `800x600`.
    pub fn size(&self) -> String {
        format!("{}x{}", self.settings.width, self.settings.height)
    }

    /// Errors of the surface; the floor's picture has none to err from.
    pub fn surface(&self) -> Option<&Comparison> {
        (self.settings.method != Method::Floor).then_some(&self.errors)
    }

    /// True if the time is known to within `most`, half the width of its interval over the value.
    pub fn resolved(&self, most: f64) -> bool {
        self.time().is_some_and(|t| t.relative() <= most)
    }

    /// The bound on steps.
    pub fn max_steps(&self) -> u32 {
        let beveled = self.offset.is_some_and(|o| o.bevel != 0.0);
        let own = self.settings.method.default_steps(beveled);
        self.settings.max_steps.unwrap_or(own)
    }

    /// All samples of the device's clock, ms; empty where it has none.
    pub fn gpu_ms(&self) -> Vec<f64> {
        let samples = self.passes.iter().flatten();
        samples.filter_map(|s| s.gpu_ms).collect()
    }

    /// All samples of the wall clock, ms.
    pub fn frame_ms(&self) -> Vec<f64> {
        self.passes.iter().flatten().map(|s| s.frame_ms).collect()
    }

    /// Agreement of the two clocks.
    pub fn clocks(&self) -> Clocks {
        Clocks::of(
            self.typical(|s| s.gpu_ms),
            self.typical(|s| Some(s.frame_ms)),
        )
    }

    /// The median of each pass, ms.
    pub fn pass_medians(&self) -> Vec<f64> {
        self.medians(|s| Some(s.ms()))
    }

    /// The geometric mean of the passes' medians of one clock, ms.
    pub(crate) fn typical(&self, of: impl Fn(&Sample) -> Option<f64>) -> Option<f64> {
        stats::geometric(&self.medians(of)).map(|i| i.value)
    }

    fn medians(&self, of: impl Fn(&Sample) -> Option<f64>) -> Vec<f64> {
        let median =
            |pass: &Vec<Sample>| stats::median(&pass.iter().filter_map(&of).collect::<Vec<_>>());
        self.passes.iter().filter_map(median).collect()
    }

    /// The time of a frame, ms; `None` where the clocks disagree, or nothing was timed.
    pub fn time(&self) -> Option<Interval> {
        match self.clocks() {
            Clocks::Disagree { .. } => None,
            Clocks::Agree | Clocks::Wall => stats::geometric(&self.pass_medians()),
        }
    }
}

#[cfg(test)]
pub(crate) mod tests;
