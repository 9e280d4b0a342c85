//! `revmap mesh`: the solids of a scene as triangles.

use super::options::positive;
use super::output::{self, usage};
use super::progress::Progress;
use super::reading::Input;
use clap::Args;
use revmap::error::{Error, Result};
use revmap::profile::loop_area;
use revmap::scene::{Object, Scene};
use revmap_files::{MESH_ENDINGS, SceneFile, mesh_files, stl_rounding, write_meshes};
use revmap_tessellation::{Triangles, pixel_tolerance};
use std::path::PathBuf;

/// Writes the solids of a scene as triangles, for modelling, printing and physics
#[derive(Args)]
#[command(
    after_help = "A .glb holds colours, colour maps and a node for each copy, with y up. An .obj holds the \
same, with copies written out, and a .mtl and pictures beside it. An .stl holds the triangles alone, with z up.\n\n\
    Examples:\n  \
    revmap mesh assets/profiles/pawn.svg -o pawn.glb\n  \
    revmap mesh assets/scenes/chess.toml -o chess.glb --tolerance 0.002\n  \
    revmap mesh assets/scenes/pawn.toml -o far.glb --pixels 0.5 --distance 20\n  \
    revmap mesh pawn.svg -o pawn.stl --set object.0.scale=[40,40,40]"
)]
pub struct Mesh {
    #[command(flatten)]
    input: Input,
    /// The file: .glb, .obj or .stl
    #[arg(long, short, value_name = "FILE")]
    output: PathBuf,
    /// Largest distance between the triangles and the solid, object units (1 is the height of the
    /// box, before scale)
    #[arg(long, value_name = "LENGTH", default_value_t = 5e-4)]
    tolerance: f64,
    /// The largest distance in pixels, in place of --tolerance: those in the middle of a picture
    /// through the scene's camera
    #[arg(long, value_name = "PIXELS", conflicts_with = "tolerance", value_parser = positive)]
    pixels: Option<f64>,
    /// World units from the eye to the solids, for --pixels [default: to the nearest copy of each, as
    /// the scene has it]
    #[arg(long, value_name = "LENGTH", requires = "pixels", value_parser = positive)]
    distance: Option<f64>,
    /// Rows of the picture, for --pixels [default: 1080]
    #[arg(long, value_name = "N", requires = "pixels", value_parser = clap::value_parser!(u32).range(1..=16384))]
    rows: Option<u32>,
    /// Moves everything so that the position of the first object is the origin: coordinates far
    /// from it lose digits in an .stl, and in most programs that read the other formats
    #[arg(long)]
    at_origin: bool,
    /// Say nothing but failures
    #[arg(long, short)]
    quiet: bool,
}

impl Mesh {
    pub fn run(self) -> Result<()> {
        let Input {
            scene,
            outline,
            set,
        } = &self.input;
        let outputs = outline.output();
        let outputs = outputs.and("--output", [&self.output], &MESH_ENDINGS);
        outputs.check(&[scene])?;
        let mut file = SceneFile::open(scene)?;
        let mut scene = file.scene(set)?;
        if self.at_origin {
            move_to_origin(&mut scene);
        }
        let written = mesh_files(&scene, &self.output);
        let outputs = outputs.and("--output", &written[1..], &[]);
        outputs.spare(file.files())?;
        outline.finish(&file, &scene, self.quiet)?;
        let progress = Progress::start("making triangles", self.quiet);
        let mut meshes = Vec::new();
        for (number, object) in scene.objects.iter().enumerate() {
            let mut tolerance = self.tolerance_of(&scene, object)?;
            if output::has_ending(&self.output, "stl") && tolerance > Triangles::FINEST {
                // Rounding has at most an eighth of the tolerance; more is refused by the writer.
                let least = Triangles::FINEST.max(0.875 * tolerance);
                tolerance = (tolerance - stl_rounding(object)).max(least);
            }
            let made = Triangles::new(object, tolerance);
            meshes.push(made.map_err(|e| self.named(e, number))?);
            progress.report(number + 1, scene.objects.len());
        }
        write_meshes(&scene, &meshes, &self.output).map_err(|e| self.with_hint(e))?;
        drop(progress);
        if self.quiet {
            return Ok(());
        }
        warnings(&scene).iter().for_each(|w| output::warn(w));
        for file in &written[1..] {
            output::note(&format!("beside it: {}", file.display()));
        }
        let count: usize = meshes.iter().map(|m| m.indices.len() / 3).sum();
        let copies: usize = scene.objects.iter().map(|o| o.placements().len()).sum();
        let bytes = std::fs::metadata(&self.output).map_or(0, |m| m.len());
        let within = match self.pixels {
            Some(pixels) => format!("{pixels} pixels"),
            None => format!("{} object units", self.tolerance),
        };
        output::result(&format!(
            "{}: {count} triangles of {}, {}, within {within}; {bytes} bytes",
            self.output.display(),
            counted(meshes.len(), "solid", "solids"),
            counted(copies, "copy", "copies"),
        ));
        Ok(())
    }

    /// The tolerance of an object of the scene, object units.
    fn tolerance_of(&self, scene: &Scene, object: &Object) -> Result<f64> {
        let Some(pixels) = self.pixels else {
            return Ok(self.tolerance);
        };
        let rows = self.rows.unwrap_or(1080);
        pixel_tolerance(object, &scene.camera, rows, pixels, self.distance).ok_or_else(|| {
            let message = format!(
                "{}: the eye is within its box; give a distance",
                object.name
            );
            usage("--distance", message)
        })
    }

    /// A failure of writing, with the option that may mend it.
    fn with_hint(&self, mut error: Error) -> Error {
        let is_far = |key: &String| key.ends_with(".position");
        if !self.at_origin && error.key.as_ref().is_some_and(is_far) {
            error.message += "; --at-origin moves the first object to the origin";
        }
        error
    }

    /// A failure with the option or the object's key, and the scene's file.
    fn named(&self, error: Error, number: usize) -> Error {
        match error.key.clone() {
            Some(key) if key == "tolerance" => {
                let option = self.pixels.map_or("--tolerance", |_| "--pixels");
                usage(option, error.message)
            }
            Some(key) => Error {
                key: Some(format!("object.{number}.{key}")),
                ..error.in_file(&self.input.scene)
            },
            None => error.in_file(&self.input.scene),
        }
    }
}

/// Moves objects and camera so that the position of the first object is the origin.
fn move_to_origin(scene: &mut Scene) {
    let Some(first) = scene.objects.first().map(|o| o.placements()[0].position) else {
        return;
    };
    scene.camera.eye -= first;
    scene.camera.target -= first;
    for object in &mut scene.objects {
        let mut copies = object.placements().to_vec();
        copies.iter_mut().for_each(|copy| copy.position -= first);
        match object.instances.is_empty() {
            true => object.placement = copies[0],
            false => object.instances = copies.into(),
        }
    }
}

/// Parts of the scene that no mesh has.
fn warnings(scene: &Scene) -> Vec<String> {
    let mut found = Vec::new();
    for (number, object) in scene.objects.iter().enumerate() {
        let warnings = &object.profile.warnings;
        found.extend(warnings.iter().map(|w| format!("object.{number}: {w}")));
        let loops = object.profile.outline.loops.iter();
        let hollows = loops.filter(|points| loop_area(points) < 0.0).count();
        if hollows > 0 && !warnings.iter().any(|w| w.contains("closed hollow")) {
            let hollows = counted(hollows, "closed hollow", "closed hollows");
            found.push(format!(
                "object.{number}: the profile has {hollows}, which a print keeps; remove the light shapes if none is meant"
            ));
        }
        if object.color.iter().any(|v| *v > 1.0) && object.texturing.color_map.is_none() {
            found.push(format!(
                "object.{number}.color: a mesh has no colours above 1; 1 is written"
            ));
        }
        if object.texturing.displacement_map.is_some() && object.texturing.bump != 0.0 {
            found.push(format!(
                "object.{number}.height_map: a mesh has no bumps; they are left out"
            ));
        }
    }
    found
}

fn counted(count: usize, one: &str, many: &str) -> String {
    format!("{count} {}", if count == 1 { one } else { many })
}
