//! What a measurement draws with, and who waits for it.

use crate::measure::row::{Row, Sample};
use crate::plan::method::MethodSettings;
use crate::plan::view::View;
use crate::plan::{Case, Plan};
use revmap::error::Result;
use revmap::frame::Frame;
use revmap_compare::CompareOptions;
use std::sync::atomic::AtomicBool;

/// Draws one frame of a view, which is made ready before, and waits for it.
pub type TimedDraw = Box<dyn FnMut() -> Result<Sample>>;

/// A source of timed frames and pictures: a Vulkan device, or a stand-in of tests.
pub trait Bench {
    /// Makes everything ready to draw `view` as `settings` say.
    ///
    /// # Errors
    /// This way of drawing does not apply to the view; a failure of the device itself is
    /// [`DeviceLost`](revmap::error::ErrorKind::DeviceLost) and ends the run.
    fn timed(&mut self, view: &View, settings: &MethodSettings) -> Result<TimedDraw>;

    /// One frame with all planes, and the bytes of its maps.
    fn picture(&mut self, view: &View, settings: &MethodSettings) -> Result<(Frame, u64)>;

    /// The truth.
    fn truth(&mut self, view: &View, settings: &MethodSettings) -> Result<Frame>;
}

/// Whoever waits for the measurement.
pub struct Observer<'a> {
    /// Set from anywhere to end early; what was measured is kept.
    pub stop: &'a AtomicBool,
    /// Told what is under way, milliseconds gone, and milliseconds expected in all.
    pub progress: &'a dyn Fn(&str, u64, u64),
    /// Shown every picture once, with what should be seen.
    pub picture: &'a mut dyn FnMut(&RenderedCase) -> Result<()>,
    /// Given the rows so far after each pass, so that not even a crash loses them.
    pub passed: &'a mut dyn FnMut(&[Row]) -> Result<()>,
}

/// A picture and its measure.
#[allow(missing_docs)] // names say it
pub struct RenderedCase<'a> {
    pub plan: &'a Plan,
    pub case: &'a Case,
    pub frame: &'a Frame,
    pub truth: &'a Frame,
    pub options: &'a CompareOptions,
}
