//! What is read: a scene or a profile with changed keys, and what a photograph was read as.

use super::output::{self, Outputs, usage};
use clap::Args;
use revmap::error::Result;
use revmap::scene::Scene;
use revmap_files::{Picture, SceneFile};
use std::path::PathBuf;

/// A scene and changes of it
#[derive(Args, Clone, Debug)]
pub struct Input {
    /// The scene, a TOML file; or a profile, an SVG drawing or a picture, which is read with
    /// profile_read = "auto" and profile_smooth = "auto"
    pub scene: PathBuf,
    #[command(flatten)]
    pub outline: ShownOutline,
    /// Any key of the scene, as in object.0.bevel=0.4; may be given more than once
    #[arg(long, value_name = "KEY=VALUE")]
    pub set: Vec<String>,
}

/// Outlines of pictures
#[derive(Args, Clone, Debug)]
pub struct ShownOutline {
    /// Also writes the picture that the profile was read from, with the outline over it
    #[arg(long, value_name = "FILE.png")]
    show_outline: Option<PathBuf>,
}

impl ShownOutline {
    /// The file, to be checked with others.
    pub fn output(&self) -> Outputs<'_> {
        Outputs::default().and("--show-outline", &self.show_outline, &["png"])
    }

    /// Writes what `shown` gives, if that is asked for.
    pub fn write(&self, shown: impl FnOnce() -> Result<Option<Picture>>) -> Result<()> {
        let Some(file) = &self.show_outline else {
            return Ok(());
        };
        let none = "is for pictures, and no profile of the scene is one; leave it out: \
                    the outline of a drawing is the drawing";
        let picture = shown()?.ok_or_else(|| usage("--show-outline", none))?;
        picture.write_png(file)
    }

    /// Writes the outline over the first picture of a scene, and prints what photographs were read
    /// as.
    pub fn finish(&self, file: &SceneFile, scene: &Scene, quiet: bool) -> Result<()> {
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
