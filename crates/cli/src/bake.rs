//! `revmap bake`: the maps that a solid is drawn from, as images.

use super::failure::with_options;
use super::options::named;
use super::output::{self, Outputs};
use super::progress::Progress;
use super::reading::tell;
use clap::Args;
use revmap::error::Result;
use revmap::maps::{BakeOptions, MapSource, ShapeMap, SlopeFilter};
use revmap::profile::Profile;
use revmap::scene::Object;
use revmap_files::{ProfileAxis, ProfileOptions, ProfileRead, Smooth, projection_of};
use std::path::{Path, PathBuf};
use std::time::Instant;

/// Writes a profile's shape map, and a height map's displacement map, as images
#[derive(Args)]
#[command(after_help = "Examples:\n  \
    revmap bake assets/profiles/pawn.svg -o pawn-map.png\n  \
    revmap bake assets/profiles/bottle.png -o bottle.exr --height-map assets/heights/brick.png")]
pub struct Bake {
    #[command(flatten)]
    profile: ProfileArguments,
    /// File of the shape map: .png (8-bit RGBA: gradient, distance, form) or .exr (32-bit floats,
    /// without loss)
    #[arg(long, short, value_name = "MAP")]
    output: PathBuf,
    /// Rows of the shape map
    #[arg(long, value_name = "N", default_value_t = Object::MAP_ROWS, value_parser = clap::value_parser!(u32).range(2..=16384))]
    map_rows: u32,
    /// Source of distances [default: exact]
    #[arg(long, value_name = "SOURCE", value_parser = named(&revmap_files::MAP_SOURCES))]
    map_source: Option<MapSource>,
    /// A picture of heights, whose displacement map is written beside the shape map, as
    /// vase.displacement.png
    #[arg(long, value_name = "FILE")]
    height_map: Option<PathBuf>,
    /// Say nothing but failures
    #[arg(long, short)]
    quiet: bool,
}

/// A profile and how it is read
#[derive(Args)]
pub struct ProfileArguments {
    /// The profile: an SVG drawing, or a PNG or JPEG picture, dark = solid
    pub profile: PathBuf,
    /// Position of the axis: left (half a profile), center (a silhouette), or a fraction of the width
    /// [default: center]
    #[arg(long, value_name = "AXIS")]
    profile_axis: Option<ProfileAxis>,
    /// Grey level below which a picture's pixel is solid, from 0 (black) to 1 (white) [default: 0.5]
    #[arg(long, value_name = "LEVEL")]
    profile_threshold: Option<f64>,
    /// The way in which the solid of a picture is found: auto finds ground, thing, axis and tilt of a
    /// photograph, threshold takes what is dark about the given axis [default: threshold in bake and
    /// with an axis, threshold or inversion, else auto]
    #[arg(long, value_name = "WAY", value_parser = named(&ProfileRead::NAMES))]
    profile_read: Option<ProfileRead>,
    /// Light is solid, dark is empty
    #[arg(long)]
    profile_invert: bool,
    /// Blurs noise of a picture away by a Gaussian of this standard deviation; auto: as wide as the
    /// noise needs, none for a clean picture [default: 0 in bake, auto in profile]
    #[arg(long, value_name = "PIXELS|auto", value_parser = smooth)]
    profile_smooth: Option<Smooth>,
    /// Leaves out strokes of a drawing thinner than this part of its height, such as dimension lines
    #[arg(long, value_name = "PART", default_value_t = 0.0)]
    profile_min_stroke: f64,
}

impl ProfileArguments {
    /// The options; `read` and `smooth` hold where none says otherwise.
    pub fn options(&self, read: ProfileRead, smooth: Smooth) -> ProfileOptions {
        let default = ProfileOptions::default();
        let by_threshold =
            self.profile_axis.is_some() || self.profile_threshold.is_some() || self.profile_invert;
        let read = [read, ProfileRead::Threshold][usize::from(by_threshold)];
        ProfileOptions {
            axis: self.profile_axis.unwrap_or(default.axis),
            read: self.profile_read.unwrap_or(read),
            threshold: self.profile_threshold.unwrap_or(default.threshold),
            invert: self.profile_invert,
            smooth: self.profile_smooth.unwrap_or(smooth),
            min_stroke: self.profile_min_stroke,
        }
    }

    /// Prints warnings of the profile, and what a photograph was read as.
    pub fn tell(&self, read: &Profile) {
        let warnings = read.warnings.iter();
        warnings.for_each(|w| output::warn(&with_options(w)));
        let name = self.profile.file_name().unwrap_or_default();
        tell(&name.to_string_lossy(), &read.notes);
    }

    /// Reads the profile.
    pub fn read(&self, options: ProfileOptions) -> Result<Profile> {
        revmap_files::profile(&self.profile, options).map_err(|mut e| {
            e.message = with_options(&e.message);
            e
        })
    }
}

impl Bake {
    pub fn run(self) -> Result<()> {
        let map_file = &self.output;
        let slopes_file = self.height_map.as_ref().map(|_| beside(map_file));
        let mut inputs = vec![self.profile.profile.as_path()];
        inputs.extend(self.height_map.as_deref());
        Outputs::default()
            .and("--output", [map_file], &["png", "exr"])
            .and("--output", &slopes_file, &["png"])
            .check(&inputs)?;

        let begin = Instant::now();
        let progress = Progress::start("baking", self.quiet);
        let options = self
            .profile
            .options(ProfileRead::Threshold, Smooth::default());
        let profile = self.profile.read(options)?;
        let source = self.map_source.unwrap_or_default();
        let options = BakeOptions::new(source, self.map_rows);
        let map =
            ShapeMap::bake(&profile, &options).map_err(|e| e.in_file(&self.profile.profile))?;
        let slopes = self.height_map.as_ref();
        let slopes = slopes.map(|f| revmap_files::displacement_map(f, SlopeFilter::default()));
        let slopes = slopes.transpose()?;
        let took = begin.elapsed().as_secs_f64() * 1e3;
        drop(progress);

        revmap_files::write_shape_map(&map, map_file)?;
        if !self.quiet {
            self.profile.tell(&profile);
            let old = beside(map_file);
            if slopes.is_none() && old.exists() {
                output::warn(&format!(
                    "{}: is of an earlier run, and stays beside the new map; remove it, or give --height-map",
                    old.display()
                ));
            }
        }
        self.tell(&format!(
            "{}: {}x{} texels, {}, baked in {took:.1} ms",
            map_file.display(),
            map.columns,
            map.rows,
            map.source.name
        ));
        if let (Some(slopes), Some(file)) = (&slopes, &slopes_file) {
            revmap_files::write_displacement_map(slopes, file)?;
            let [width, height] = slopes.size();
            let file = file.display();
            self.tell(&format!("{file}: {width}x{height} texels, slopes"));
        }
        Ok(())
    }

    fn tell(&self, line: &str) {
        if !self.quiet {
            output::result(line);
        }
    }
}

/// A number of pixels, or `auto`.
fn smooth(text: &str) -> std::result::Result<Smooth, String> {
    match (text, text.parse()) {
        ("auto", _) => Ok(Smooth::Auto),
        (_, Ok(pixels)) => Ok(Smooth::Pixels(pixels)),
        _ => Err("give a number of pixels, or auto".to_owned()),
    }
}

/// The file of the displacement map beside a shape map: `vase.displacement.png` for
/// `vase.spherical.exr`.
fn beside(map: &Path) -> PathBuf {
    let unmarked = match projection_of(map) {
        Some(_) => map.with_extension(""),
        None => map.to_path_buf(),
    };
    unmarked.with_extension("displacement.png")
}
