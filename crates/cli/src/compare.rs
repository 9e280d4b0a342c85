//! `revmap compare`: the difference of a frame from another that counts as the truth.

mod pictures;

use super::output::{self, Outputs};
use clap::Args;
use revmap::error::{Error, ErrorKind, Result};
use revmap_compare::{CompareOptions, Comparison, Reference, ViewErrors, heat_sheet};
use revmap_files::{SceneFile, read_exr};
use serde_json::json;
use std::path::PathBuf;

/// Compares two frames: wrong pixels, errors of depth and normals, silhouettes, FLIP
///
/// Two PNG pictures are compared by their colours alone.
#[derive(Args)]
#[command(after_help = "Examples:\n  \
    revmap render assets/scenes/pawn.toml -o truth.exr --stage reference\n  \
    revmap render assets/scenes/pawn.toml -o frame.exr --solver circle\n  \
    revmap compare truth.exr frame.exr --heat errors.png --scene assets/scenes/pawn.toml\n  \
    revmap compare docs/pictures/chess.png chess.png --alike")]
pub struct Compare {
    /// The frame taken for the truth, an EXR file that `render` wrote (as with --stage reference), or a
    /// PNG
    a: PathBuf,
    /// The frame in question, a file of the same kind and size
    b: PathBuf,
    /// A sheet of heat maps, one for each measure, of EXR files
    #[arg(long, value_name = "FILE.png")]
    heat: Option<PathBuf>,
    /// The scene or profile that the frames show: adds distances of silhouettes from the true outline
    /// below a pixel, and depth errors in pixels of the view
    #[arg(long, value_name = "SCENE")]
    scene: Option<PathBuf>,
    /// Any key of the scene, as it was given to `render`; may be given more than once
    #[arg(long, value_name = "KEY=VALUE", requires = "scene")]
    set: Vec<String>,
    /// Fail unless the frames agree in every bit of every channel
    #[arg(long)]
    exact: bool,
    /// Fail if PNG pictures differ visibly: more than 0.2 % of their channels by more than 3 of 255
    #[arg(long, conflicts_with_all = ["exact", "heat", "scene"])]
    alike: bool,
    /// Print one JSON object on standard output in place of text
    #[arg(long)]
    json: bool,
}

impl Compare {
    pub fn run(self) -> Result<()> {
        let png = |file: &&PathBuf| output::has_ending(file, "png");
        let of_depth = self.heat.is_some() || self.scene.is_some();
        if [&self.a, &self.b].iter().all(png) && !of_depth {
            return pictures::run([&self.a, &self.b], (self.exact, self.alike), self.json);
        }
        if self.alike {
            let message = "compares the colours of two PNG pictures; leave it out, or give two";
            return Err(Error::new(ErrorKind::Usage, message).at_key("--alike"));
        }
        for file in [&self.a, &self.b] {
            if !output::has_ending(file, "exr") {
                let message =
                    "holds no depth and no normals; give an .exr file that `revmap render` wrote";
                return Err(Error::new(ErrorKind::Usage, message).in_file(file));
            }
        }
        let outputs = Outputs::default().and("--heat", &self.heat, &["png"]);
        outputs.check(&[&self.a, &self.b])?;
        let (a, b) = (read_exr(&self.a)?, read_exr(&self.b)?);
        let options = CompareOptions::default();
        let mut truth = Reference::new(&a, &options)?;
        if let Some(scene) = &self.scene {
            truth = truth.of_scene(&SceneFile::open(scene)?.scene(&self.set)?)?;
        }
        let outcome = truth.compare(&b).map_err(|e| e.in_file(&self.b))?;
        if let Some(heat) = &self.heat {
            heat_sheet(&a, &b, &options)?.write_png(heat)?;
        }
        let difference = a.first_difference(&b).map(|d| d.to_string());
        if self.json {
            output::json(&as_json(&outcome, difference.as_deref()));
        } else {
            outcome.to_string().lines().for_each(output::result);
        }
        match difference {
            Some(difference) if self.exact => {
                let message = format!(
                    "the frames differ, first in {difference}; draw them again or leave out --exact"
                );
                return Err(Error::new(ErrorKind::Other, message).in_file(&self.b));
            }
            _ if self.json => {}
            Some(place) => output::result(&format!("bits        differ, first in {place}")),
            None => output::result("bits        equal in every channel"),
        }
        Ok(())
    }
}

/// The names of the columns of `results.csv`, and depth errors in h/512 beside them; values that do
/// not apply are null. Without a scene only silhouettes without a wrong pixel are known below a pixel.
fn as_json(found: &Comparison, difference: Option<&str>) -> serde_json::Value {
    let right = (found.missed + found.ghost == 0).then_some(0.0);
    let silhouette = |of: fn(&ViewErrors) -> f64| found.view.as_ref().map(of).or(right);
    json!({
        "pixels": found.pixels,
        "hits": found.hits,
        "missed": found.missed,
        "ghost": found.ghost,
        "depth_rms_texels": found.depth.map(|d| d.rms),
        "depth_p99_texels": found.depth.map(|d| d.p99),
        "depth_max_texels": found.depth.map(|d| d.max),
        "depth_rms_h512": found.depth_h512().map(|d| d.rms),
        "depth_p99_h512": found.depth_h512().map(|d| d.p99),
        "depth_max_h512": found.depth_h512().map(|d| d.max),
        "normal_rms_degrees": found.normal.map(|n| n.rms),
        "normal_p99_degrees": found.normal.map(|n| n.p99),
        "normal_max_degrees": found.normal.map(|n| n.max),
        "silhouette_hausdorff_px": found.silhouette_hausdorff,
        "silhouette_p999_px": silhouette(|v| v.silhouette_p999),
        "silhouette_max_px": silhouette(|v| v.silhouette_max),
        "depth_p99_px": found.view.map(|v| v.depth_p99),
        "flip": found.flip,
        "first_difference": difference,
    })
}
