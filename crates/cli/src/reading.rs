//! What a photograph was read as: one line, and a picture.

use super::output::{self, usage};
use clap::Args;
use revmap::error::Result;
use revmap::scene::Scene;
use revmap_files::{Picture, SceneFile};
use std::path::{Path, PathBuf};

/// Outlines of pictures
#[derive(Args, Clone, Debug, Default)]
pub struct ShownOutline {
    /// Also writes the picture that the profile was read from, with the outline over it
    #[arg(long, value_name = "FILE.png")]
    show_outline: Option<PathBuf>,
}

impl ShownOutline {
    /// Checks the file, before any work.
    pub fn check(&self, input: &Path) -> Result<()> {
        output::check(&self.show_outline, "--show-outline", &["png"], &[input])
    }

    /// Writes what `shown` gives, if that is asked for.
    pub fn write(&self, shown: impl FnOnce() -> Result<Option<Picture>>) -> Result<()> {
        let Some(file) = &self.show_outline else {
            return Ok(());
        };
        match shown()? {
            Some(picture) => picture.write_png(file),
            None => Err(usage(
                "--show-outline",
                "the scene has no profile from a picture",
            )),
        }
    }

    /// Writes the outline over the first picture of a scene, and prints what photographs were read
    /// as.
    pub fn finish(&self, file: &SceneFile, scene: &Scene, quiet: bool) -> Result<()> {
        output::spare(file.files(), &self.show_outline, "--show-outline")?;
        self.write(|| file.show_outline())?;
        for object in scene.objects.iter().filter(|_| !quiet) {
            tell(&object.name, &object.profile.notes);
        }
        Ok(())
    }
}

/// Prints what a photograph was read as.
pub fn tell(name: &str, notes: &[String]) {
    for note in notes {
        output::note(&format!("{name}: {note}"));
    }
}
