//! `revmap profile`: the outline that is drawn, as a drawing of a few curves.

use super::bake::ProfileArguments;
use super::output::{self, usage};
use super::reading::ShownOutline;
use clap::Args;
use revmap::error::Result;
use revmap_files::{ProfileRead, Smooth, show_outline, write_outline};
use std::path::PathBuf;

/// A larger part of the area that differs is told.
const CHANGED: f64 = 0.01;

/// Writes the outline of a drawing or picture as an SVG of a few curves, to be changed by hand
#[derive(Args)]
#[command(after_help = "Examples:\n  \
    revmap profile photo.jpg -o clean.svg --tolerance 0.001 --show-outline check.png\n  \
    revmap profile assets/profiles/bottle.png -o bottle.svg\n  \
    revmap render bottle.svg -o bottle.png")]
pub struct Profile {
    #[command(flatten)]
    profile: ProfileArguments,
    #[command(flatten)]
    outline: ShownOutline,
    /// The drawing
    #[arg(long, short, value_name = "FILE.svg")]
    output: PathBuf,
    /// Largest distance between the curves and the outline, object units (1 is the height)
    #[arg(long, value_name = "LENGTH", default_value_t = 1e-5)]
    tolerance: f64,
    /// Say nothing but failures
    #[arg(long, short)]
    quiet: bool,
}

impl Profile {
    pub fn run(self) -> Result<()> {
        let outputs = self.outline.output();
        let outputs = outputs.and("--output", [&self.output], &["svg"]);
        outputs.check(&[&self.profile.profile])?;
        // As `render` reads a profile in place of a scene.
        let options = self.profile.options(ProfileRead::Auto, Smooth::Auto);
        let profile = self.profile.read(options)?;
        let shown = || show_outline(&self.profile.profile, options).map(Some);
        self.outline.write(shown)?;
        let written =
            write_outline(&profile, &self.output, self.tolerance).map_err(|e| match &e.key {
                Some(_) => usage("--tolerance", e.message),
                None => e,
            })?;
        if !self.quiet {
            self.profile.tell(&profile);
            if written.changed > CHANGED {
                output::warn(&format!(
                    "--tolerance: {:.0} % of the solid's area changed; parts thinner than the tolerance merge or vanish, give a smaller one",
                    100.0 * written.changed
                ));
            }
            let points: usize = profile.outline.loops.iter().map(Vec::len).sum();
            output::result(&format!(
                "{}: {} lines and {} curves for {points} points, within {} of the height",
                self.output.display(),
                written.lines,
                written.curves,
                self.tolerance
            ));
        }
        Ok(())
    }
}
