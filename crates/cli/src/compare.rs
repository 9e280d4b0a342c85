//! `revmap compare`: how far a frame is from another that is taken for the truth.

use super::output;
use clap::Args;
use revmap::error::{Error, Result, Stage};
use revmap::frame;
use revmap_lab::compare::{CompareOptions, compare, heat_sheet};
use std::path::PathBuf;

/// Compares two frames: wrong pixels, errors of depth and normals, silhouettes, FLIP
#[derive(Args)]
pub struct Compare {
    /// The frame taken for the truth, an EXR file that `render` wrote (as with --stage reference)
    a: PathBuf,
    /// The frame in question, an EXR file of the same size
    b: PathBuf,
    /// A sheet of heat maps, one for each measure
    #[arg(long, value_name = "FILE.png")]
    heat: Option<PathBuf>,
    /// Length of a texel of the shape map in world units, in which errors of depth are told [default: 1/512]
    #[arg(long, value_name = "LENGTH", value_parser = positive)]
    texel: Option<f64>,
    /// Fail unless the frames agree in every bit of every channel
    #[arg(long)]
    exact: bool,
}

impl Compare {
    pub fn run(self) -> Result<()> {
        for file in [&self.a, &self.b] {
            if !output::has_ending(file, "exr") {
                return Err(Error::new(
                    Stage::Usage,
                    "holds no depth and no normals; give an .exr file that `revmap render` wrote",
                )
                .in_file(file));
            }
        }
        if let Some(heat) = &self.heat {
            output::check(std::slice::from_ref(heat), "--heat", &["png"], &[])?;
        }
        let (a, b) = (frame::read_exr(&self.a)?, frame::read_exr(&self.b)?);
        let mut options = CompareOptions::default();
        options.texel = self.texel.unwrap_or(options.texel);
        let outcome = compare(&a, &b, &options).map_err(|e| e.in_file(&self.b))?;
        if let Some(heat) = &self.heat {
            heat_sheet(&a, &b, &options)?.write_png(heat)?;
        }
        for line in outcome.to_string().lines() {
            output::result(line);
        }
        match a.first_difference(&b) {
            Some(difference) if self.exact => Err(Error::new(
                Stage::Frame,
                format!(
                    "the frames differ, first in {difference}; draw them again or leave out --exact"
                ),
            )
            .in_file(&self.b)),
            Some(difference) => {
                output::result(&format!("bits        differ, first in {difference}"));
                Ok(())
            }
            None => {
                output::result("bits        equal in every channel");
                Ok(())
            }
        }
    }
}

fn positive(text: &str) -> std::result::Result<f64, String> {
    match text.parse::<f64>() {
        Ok(x) if x.is_finite() && x > 0.0 => Ok(x),
        _ => Err("give a number above 0".to_owned()),
    }
}
