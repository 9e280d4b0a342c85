//! `revmap shading`: a host's function of shading, checked and written as bytes.

use super::options::named;
#[cfg(feature = "shaderc")]
use super::output;
use clap::Args;
use revmap::error::Result;
use revmap::settings::DrawStage;
use std::path::PathBuf;

/// Compiles a host's function of shading, for engines that embed revmap without a compiler
///
/// docs/embedding.md describes the function. Without --output its text is only checked.
#[derive(Args)]
#[command(after_help = "Examples:\n  \
    revmap shading examples/forward/shade.glsl\n  \
    revmap shading shade.glsl lights.glsl -o shade.shading\n  \
    revmap shading shade.glsl -o tiles.shading --stage compute")]
pub struct Shading {
    /// The GLSL that defines host_shade, then files that it includes, by their names without folders
    #[arg(value_name = "GLSL", required = true)]
    files: Vec<PathBuf>,
    /// File of the bytes (.shading) for Shading::from_bytes and revmap_shading_from_bytes
    #[arg(long, short, value_name = "FILE")]
    output: Option<PathBuf>,
    /// The stage that shades
    #[arg(long, value_name = "STAGE", default_value = "fragment", value_parser = named(&DrawStage::NAMES))]
    stage: DrawStage,
}

#[cfg(feature = "shaderc")]
impl Shading {
    /// Compiles, and writes the bytes.
    ///
    /// # Errors
    /// [`ErrorKind::File`](revmap::error::ErrorKind::File) for files;
    /// [`ErrorKind::Content`](revmap::error::ErrorKind::Content) with the line, for the GLSL.
    pub fn run(self) -> Result<()> {
        use revmap::error::{Error, ErrorKind};
        let inputs: Vec<_> = self.files.iter().map(PathBuf::as_path).collect();
        let outputs = output::Outputs::default();
        outputs
            .and("--output", &self.output, &["shading"])
            .check(&inputs)?;
        let mut texts = Vec::new();
        for (n, file) in self.files.iter().enumerate() {
            let text = std::fs::read_to_string(file).map_err(|e| {
                let message = format!("cannot be read ({e})");
                Error::new(ErrorKind::File, message).in_file(file)
            })?;
            let included = file.file_name().filter(|_| n > 0);
            let name = included.unwrap_or(file.as_os_str()).to_string_lossy();
            texts.push((name, text));
        }
        let texts: Vec<_> = texts
            .iter()
            .map(|(name, text)| (&**name, &**text))
            .collect();
        let made = revmap::shading::Shading::compile(self.stage, &texts)?;
        let Some(file) = &self.output else {
            return Ok(());
        };
        let bytes = made.to_bytes()?;
        revmap_files::write_bytes(file, &bytes)?;
        output::result(&format!("{}: {} bytes", file.display(), bytes.len()));
        Ok(())
    }
}

#[cfg(not(feature = "shaderc"))]
impl Shading {
    /// Fails with the feature that compiles.
    ///
    /// # Errors
    /// [`ErrorKind::Usage`](revmap::error::ErrorKind::Usage), always.
    pub fn run(self) -> Result<()> {
        use revmap::error::{Error, ErrorKind};
        let message = "shading: this program was built without the feature `shaderc`, which compiles GLSL; \
                       build it with its default features";
        Err(Error::new(ErrorKind::Usage, message))
    }
}
