//! Submissions: the figures of one device in a small text file, which strangers send.
//!
//! A submission is TOML. Comments at its top say what it holds. Its last line is a checksum of all
//! text before it. The structures here are the whole content: a file with any other key is refused.

pub mod gather;
mod make;

pub use make::make;

use crate::measure::RenderedCase;
use crate::measure::drawn::fnv1a_64;
use crate::plan::method::MethodSettings;
use revmap::error::{Error, ErrorKind, Result};
use revmap_figures::stats::Interval;
use revmap_figures::table::text_of;
use revmap_files::Picture;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::path::Path;

/// The version of the format. Files of another one are refused.
pub const FORMAT: u32 = 1;

/// The first lines of every file.
const HEAD: &str = "\
# Figures of revmap on one device, written by `revmap submit`.
# Nothing personal is in this file: no name of a person or of a machine, no folder, no address. It names
# the device, its driver, the processor and the system. It holds times and errors of pictures that the
# program carries. Read it before you send it. CONTRIBUTING.md of revmap says where to.
# Times are milliseconds of a frame and ratios are times over the RBM baseline's in the fragment stage,
# each as [value, low, high] with a 95 % interval. Depth errors are 99th percentiles in h/512.
";

/// The start of the last line.
const SUM: &str = "checksum = ";

/// A value, and the ends of its 95 % interval.
pub type Figure = [f64; 3];

/// The figures of one device.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Submission {
    /// [`FORMAT`] of the program that wrote it.
    pub format: u32,
    /// The program and its version.
    pub program: String,
    /// The plan that was measured: `submit`, or `submit --quick`.
    pub plan: String,
    /// The day, UTC: `2026-01-31`.
    pub date: String,
    /// The clock by which lines are timed: `device, where the wall clock agrees`, `device` on GPUs,
    /// `wall` on devices without a clock.
    pub clock: String,
    /// Pixels of each picture: `800x600`.
    pub size: String,
    /// A digest of the scene of each view; none in files of earlier versions.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub drawn: BTreeMap<String, String>,
    /// The device.
    pub device: Described,
    /// The main table: every method in both stages, over groups of pictures.
    pub lines: Vec<Line>,
    /// Every picture by every method.
    pub pictures: Vec<OnePicture>,
    /// What the driver's compiler says of the shaders; none if the driver says nothing.
    pub shaders: Vec<OneShader>,
}

/// A device, its driver and what is around it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Described {
    /// The Vulkan device's name.
    pub name: String,
    /// `discrete`, `integrated`, `virtual`, `cpu` or `other`.
    pub kind: String,
    /// Driver and version.
    pub driver: String,
    /// Vulkan version, such as `1.3.230`.
    pub vulkan: String,
    /// The processor with its threads.
    pub processor: String,
    /// The system.
    pub system: String,
}

/// A line of the main table: one method in one stage over a group of pictures.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Line {
    /// The group: `all`, `whole` or `close`.
    pub part: String,
    /// The method, as tables name it.
    pub method: String,
    /// `fragment` or `compute`.
    pub stage: String,
    /// How many pictures count.
    pub pictures: usize,
    /// Geometric mean of the medians, ms.
    pub time_ms: Figure,
    /// Time over that of the RBM baseline in the fragment stage.
    pub ratio: Figure,
    /// Wrong pixels over the pixels hit; none of the floor.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub wrong: Option<f64>,
    /// Geometric mean of the depth errors, h/512; none of the floor.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub depth_p99: Option<f64>,
    /// The largest depth error of a picture, h/512; none of the floor.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub worst_depth_p99: Option<f64>,
}

/// One picture by one method.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct OnePicture {
    /// The view.
    pub scene: String,
    /// The method, as tables name it.
    pub method: String,
    /// `fragment` or `compute`.
    pub stage: String,
    /// Median of the device's clock, ms; none if the device has no clock. Present also if it
    /// disagrees with the wall clock, and the picture counts in no line.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub gpu_ms: Option<f64>,
    /// Median of the wall clock, ms.
    pub frame_ms: f64,
    /// Missed and ghost pixels.
    pub wrong: usize,
    /// Depth error, h/512; none without a hit.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub depth_p99: Option<f64>,
    /// Checksum of the picture's colours as a PNG stores them.
    pub colors: String,
}

/// One shader as the driver's compiler describes it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct OneShader {
    /// The search.
    pub solver: String,
    /// `fragment` or `compute`.
    pub stage: String,
    /// How the object is drawn.
    pub path: String,
    /// The shader's name in the driver's words.
    pub shader: String,
    /// Invocations of a subgroup.
    pub subgroup_size: u32,
    /// The driver's own statistics: registers, instructions, spills.
    pub statistics: BTreeMap<String, f64>,
}

impl Submission {
    /// The file's text.
    pub fn text(&self) -> Result<String> {
        let mut text = format!("{HEAD}\nformat = {}\n", inline(&self.format)?);
        for (key, value) in [
            ("program", &self.program),
            ("plan", &self.plan),
            ("date", &self.date),
            ("clock", &self.clock),
            ("size", &self.size),
        ] {
            text += &format!("{key} = {}\n", inline(value)?);
        }
        if !self.drawn.is_empty() {
            text += &format!("drawn = {}\n", inline(&self.drawn)?);
        }
        text += &format!("device = {}\n", inline(&self.device)?);
        text += &list("lines", &self.lines)?;
        text += &list("pictures", &self.pictures)?;
        text += &list("shaders", &self.shaders)?;
        let sum = fnv1a_64(text.bytes());
        Ok(format!("{text}{SUM}\"{sum:016x}\"\n"))
    }

    /// Reads a file's text. Line ends of other systems are accepted.
    ///
    /// # Errors
    /// [`ErrorKind::File`]: another format, a checksum that differs, a key that is missing or
    /// unknown.
    pub fn parse(text: &str) -> Result<Self> {
        let fault = |message: &str| Err(Error::new(ErrorKind::File, message));
        let text = text.replace("\r\n", "\n");
        let Some(end) = text.rfind(&format!("\n{SUM}")) else {
            return fault(
                "is no whole submission: its last line, the checksum, is missing; write it again with `revmap submit`",
            );
        };
        let (content, last) = text.split_at(end + 1);
        let format = content
            .lines()
            .find_map(|line| line.strip_prefix("format = "));
        if format != Some(FORMAT.to_string().as_str()) {
            let message = format!(
                "has format {}, this program reads {FORMAT}; gather it by the version that wrote it, or write it again",
                format.unwrap_or("none")
            );
            return fault(&message);
        }
        let sum = format!("{SUM}\"{:016x}\"", fnv1a_64(content.bytes()));
        if last.trim_end() != sum {
            return fault(
                "was changed: its checksum differs from its content; get the file again from its sender",
            );
        }
        toml::from_str(content).or_else(|e| {
            let message = format!(
                "is damaged ({}); write it again with `revmap submit`",
                e.message()
            );
            fault(&message)
        })
    }

    /// Reads a file.
    ///
    /// # Errors
    /// Those of [`Submission::parse`], and a file that cannot be read; the file is named.
    pub fn load(file: &Path) -> Result<Self> {
        let text = text_of(file, "give a file that `revmap submit` wrote")?;
        Self::parse(&text).map_err(|e| e.in_file(file))
    }
}

/// A value in one line, its keys in the order of the structure.
fn inline(value: &impl Serialize) -> Result<String> {
    let mut text = String::new();
    let serializer = toml::ser::ValueSerializer::new(&mut text);
    value.serialize(serializer).map_err(|e| {
        let message = format!("a submission cannot be written ({e}); report this");
        Error::new(ErrorKind::Other, message)
    })?;
    Ok(text)
}

/// A list with one entry a line.
fn list(key: &str, all: &[impl Serialize]) -> Result<String> {
    let mut text = format!("{key} = [\n");
    for one in all {
        text += &format!("  {},\n", inline(one)?);
    }
    Ok(text + "]\n")
}

/// An interval as a figure with five digits.
fn figure(interval: Interval) -> Figure {
    [interval.value, interval.low, interval.high].map(short)
}

/// A number with five digits.
fn short(value: f64) -> f64 {
    revmap_figures::names::number(value, 5)
        .parse()
        .unwrap_or(value)
}

/// Checksums of the pictures of a run: 64 bits over the colours of all pixels, four bytes each, as a
/// PNG stores them.
#[derive(Default)]
pub struct Pictures(Vec<(usize, MethodSettings, u64)>);

impl Pictures {
    /// Takes a picture.
    pub fn add(&mut self, seen: &RenderedCase) -> Result<()> {
        let picture = Picture::of(seen.frame)?;
        let sum = fnv1a_64(picture.rgba.as_flattened().iter().copied());
        self.0.push((seen.case.view, seen.case.settings, sum));
        Ok(())
    }

    /// The checksum of a view drawn in one way, in hexadecimal; empty if it was not drawn.
    fn of(&self, view: usize, settings: &MethodSettings) -> String {
        let mut all = self.0.iter();
        let found = all.find(|(v, s, _)| (*v, s) == (view, settings));
        found.map_or(String::new(), |(_, _, sum)| format!("{sum:016x}"))
    }
}

#[cfg(test)]
mod tests;
