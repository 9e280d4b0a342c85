//! Moving pictures: GIF, WebP and APNG; or numbered frames in a folder.
//!
//! | format | crate | colours | 48 frames of 640 x 360 |
//! |---|---|---|---|
//! | `.gif` | `gif`, palette by `quantette` | 255 for all frames, dithered; no soft transparency | 1.73 MB, 1.6 s |
//! | `.webp` | `webp-animation` | all, with losses by `--quality` (90) | 0.43 MB, 0.4 s |
//! | `.apng` | `png` | all | 2.90 MB, 0.4 s |
//!
//! Not taken: `imagequant` (GPL), `zenwebp` (AGPL), `image-webp` (writes no animation), `webp`
//! (an older libwebp).

mod apng;
mod folder;
mod gif;
mod stillness;
mod webp;

pub use folder::{claim, frames_in};
pub use stillness::{Stillness, remedy};

use super::output::{self, usage};
use clap::Args;
use revmap::error::{Error, ErrorKind, Result};
use revmap::frame::{Frame, MAX_PIXELS};
use revmap_files::{Picture, write_bytes};
use std::path::Path;

/// Endings of the formats.
pub const ENDINGS: [&str; 3] = ["gif", "webp", "apng"];

/// A format of moving pictures.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Format {
    Gif,
    Webp,
    Apng,
}

impl Format {
    /// The format that a file's ending says.
    pub fn of(path: &Path) -> Option<Self> {
        let mut all = ENDINGS.into_iter().zip([Self::Gif, Self::Webp, Self::Apng]);
        let is = |(ending, _): &(&str, Self)| output::has_ending(path, ending);
        all.find(is).map(|(_, format)| format)
    }

    /// The most frames a second. Browsers show a frame of 10 ms or less for 100 ms. A GIF counts
    /// in hundredths of a second, so its next delay is 20 ms.
    fn fastest(self) -> u16 {
        match self {
            Self::Gif => 50,
            Self::Webp | Self::Apng => 90,
        }
    }

    /// A frame for a file. A GIF has no soft edges, so white is put behind it.
    pub fn picture(self, frame: &Frame) -> Result<Picture> {
        if self != Self::Gif {
            return Picture::of(frame);
        }
        let mut frame = frame.clone();
        for [red, green, blue, alpha] in &mut frame.color {
            let behind = 1.0 - alpha.clamp(0.0, 1.0);
            (*red, *green, *blue) = (*red + behind, *green + behind, *blue + behind);
            *alpha = 1.0;
        }
        Picture::of(&frame)
    }
}

/// How a moving picture plays
#[derive(Args, Clone, Copy, Debug)]
pub struct Playing {
    /// Frames a second of a moving picture, 1 to 90; a GIF has 50 at most [default: 25]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..))]
    fps: Option<u16>,
    /// How often a moving picture plays; 0 is for ever [default: 0]
    #[arg(long, value_name = "N")]
    loops: Option<u16>,
    /// Quality of a .webp, 1 to 100, where 100 is without loss [default: 90]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u8).range(1..=100))]
    quality: Option<u8>,
}

impl Playing {
    /// Checks the options against the output `path` (`None`: frames are not kept), before any
    /// work. Returns the format of a moving picture.
    pub fn check(
        self,
        path: Option<&Path>,
        frames: u32,
        (width, height): (u32, u32),
    ) -> Result<Option<Format>> {
        let Some(format) = path.and_then(Format::of) else {
            let given = [
                ("--fps", self.fps.is_some()),
                ("--loops", self.loops.is_some()),
                ("--quality", self.quality.is_some()),
            ];
            return match given.into_iter().find(|(_, is)| *is) {
                Some((option, _)) => Err(usage(
                    option,
                    "is of moving pictures; give --output a .gif, .webp or .apng",
                )),
                None => Ok(None),
            };
        };
        let fastest = format.fastest();
        if self.fps.is_some_and(|fps| fps > fastest) {
            let message = format!(
                "is more than {fastest}; browsers show frames of 10 ms or less for a tenth of a second; give {fastest} or less"
            );
            return Err(usage("--fps", message));
        }
        if self.quality.is_some() && format != Format::Webp {
            return Err(usage("--quality", "is of .webp; other formats have none"));
        }
        if format == Format::Webp && width.max(height) > webp::MAX_SIDE {
            let message = format!(
                "is more than {} on a side, the most of a .webp; give less",
                webp::MAX_SIDE
            );
            return Err(usage("--size", message));
        }
        // All frames are in memory until the last is drawn.
        let pixels = u64::from(frames) * u64::from(width) * u64::from(height);
        if pixels > MAX_PIXELS {
            let message = format!(
                "{frames} frames of {width}x{height} are {pixels} pixels, and a moving picture has {MAX_PIXELS} at most; give fewer or smaller frames, or a folder"
            );
            return Err(usage("--frames", message));
        }
        Ok(Some(format))
    }

    /// Frames a second.
    fn fps(self) -> u16 {
        self.fps.unwrap_or(25)
    }

    /// When frame `n` begins, in the given parts of a second, so that the error does not grow.
    fn start(self, n: usize, parts: u64) -> u64 {
        let fps = u64::from(self.fps());
        (n as u64 * parts + fps / 2) / fps
    }

    /// How often it plays; 0 is for ever.
    fn loops(self) -> u16 {
        self.loops.unwrap_or(0)
    }

    /// How long so many frames are shown, seconds.
    pub fn seconds(self, frames: u32) -> f64 {
        f64::from(frames) / f64::from(self.fps())
    }

    /// Writes the file.
    pub fn write(self, format: Format, path: &Path, frames: &[Picture]) -> Result<()> {
        let Some(first) = frames.first() else {
            return Ok(()); // there is at least one frame
        };
        let size = (first.width, first.height);
        let bytes = match format {
            Format::Gif => gif::bytes(self, size, frames),
            Format::Webp => webp::bytes(self, size, frames),
            Format::Apng => apng::bytes(self, size, frames),
        };
        write_bytes(path, &bytes.map_err(|e| e.in_file(path))?)
    }
}

/// A failure of an encoder.
fn failed(why: impl std::fmt::Display) -> Error {
    Error::new(
        ErrorKind::Other,
        format!("cannot be made ({why}); write another format"),
    )
}
