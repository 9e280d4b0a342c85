//! Options of every drawing command.

use super::output::usage;
use super::studio::Studio;
use clap::Args;
use clap::builder::{PossibleValue, PossibleValuesParser, TypedValueParser};
use revmap::error::Result;
use revmap::gpu::Device;
use revmap::maps::{MapFormat, MapSource};
use revmap::scene::Scene;
use revmap::settings::{DrawStage, Planes, Solver, Tolerance};
use revmap_bench::plan::method::{Edges, Method, MethodSettings};
use revmap_files::SceneFile;
use revmap_searches::{cache, folder};
use std::path::PathBuf;

/// The largest width and height of a picture.
const MAX_SIDE: u32 = 16384;

/// The stage that traces rays.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Tracing {
    /// A stage of the device.
    Device(DrawStage),
    /// Ground truth: the CPU, in double precision.
    Reference,
}

/// Names of the stages.
pub const STAGES: [(&str, Tracing); 3] = [
    ("fragment", Tracing::Device(DrawStage::Fragment)),
    ("compute", Tracing::Device(DrawStage::Compute)),
    ("reference", Tracing::Reference),
];

/// An earlier name of `exact`, which scripts may use.
pub const ALIAS: &str = "hull";

/// Names of the searches; the first is the default.
pub const SOLVERS: [(&str, Method); Method::ALL.len() + 2] = {
    let mut all = [("default", Method::DEFAULT); Method::ALL.len() + 2];
    all[1] = (ALIAS, Method::Search(Solver::Exact));
    let mut i = 0;
    while i < Method::ALL.len() {
        all[i + 2] = (Method::ALL[i].name(), Method::ALL[i]);
        i += 1;
    }
    all
};

/// The device that draws
#[derive(Args, Clone, Debug)]
pub struct DeviceChoice {
    /// The Vulkan device [default: the variable REVMAP_DEVICE, else discrete before integrated
    /// before virtual before CPU]
    #[arg(long, value_name = "INDEX_OR_PART_OF_NAME")]
    device: Option<String>,
}

impl DeviceChoice {
    pub fn name(&self) -> Option<&str> {
        self.device.as_deref()
    }

    pub fn open(&self) -> Result<Device> {
        Device::open(self.name())
    }
}

/// Options of a drawing and of its messages.
#[derive(Args, Clone, Debug)]
pub struct Drawing {
    /// Pixels across and down
    #[arg(long, value_name = "WIDTHxHEIGHT", default_value = "800x600", value_parser = size)]
    pub size: (u32, u32),
    /// Stage that traces rays: the fragment shader, a compute shader, or the CPU in double
    /// precision
    #[arg(long, value_name = "STAGE", default_value = "fragment", value_parser = named(&STAGES))]
    pub stage: Tracing,
    /// Search for the first hit along a ray; or the folder of another search, as in
    /// path/to/folder or path/to/folder:parameter=1.5
    #[arg(long, value_name = "NAME", default_value = "default", value_parser = MethodParser)]
    pub solver: Method,
    /// Bound on the search's steps [default: the solver's own]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=65536))]
    pub max_steps: Option<u32>,
    /// Rows of every shape map [default: each object's map_rows]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(2..=16384))]
    pub map_rows: Option<u32>,
    /// Source of distances [default: exact]
    #[arg(long, value_name = "SOURCE", value_parser = named(&revmap_files::MAP_SOURCES))]
    pub map_source: Option<MapSource>,
    /// Format of distances on the device
    #[arg(long, value_name = "FORMAT", default_value = "r32", value_parser = named(&MapFormat::NAMES))]
    pub map_format: MapFormat,
    /// Allowed error of silhouettes and depths in pixels; 0 is exact [default: 0.25; 0 where an
    /// .exr is written]
    #[arg(long, value_name = "PIXELS", value_parser = tolerance)]
    pub tolerance: Option<Tolerance>,
    #[command(flatten)]
    pub device: DeviceChoice,
    /// The most memory that buffers and pictures may take on the device, MiB [default: as much as
    /// it has]
    #[arg(long, value_name = "MIB", value_parser = clap::value_parser!(u64).range(1..=1 << 20))]
    pub memory_budget: Option<u64>,
    /// Say nothing but failures
    #[arg(long, short)]
    pub quiet: bool,
    /// Say sizes of maps, counts of steps and times too
    #[arg(long, short, conflicts_with = "quiet")]
    pub verbose: bool,
}

impl Drawing {
    /// Width over height.
    pub fn aspect(&self) -> f64 {
        f64::from(self.size.0) / f64::from(self.size.1)
    }

    /// The lab's settings. The reference uses only the size.
    pub fn settings(&self, planes: Planes) -> MethodSettings {
        MethodSettings {
            width: self.size.0,
            height: self.size.1,
            stage: match self.stage {
                Tracing::Device(stage) => stage,
                Tracing::Reference => DrawStage::Fragment,
            },
            method: self.solver,
            max_steps: self.max_steps,
            map_rows: self.map_rows,
            map_source: self.map_source,
            map_format: self.map_format,
            planes,
            tolerance: self.tolerance.unwrap_or_default(),
            edges: Edges::OneRay,
        }
    }

    /// Opens the device with the memory limit and the pipelines of earlier runs: one file per
    /// driver in the user's cache folder. Errors with this file are no failures, since pipelines
    /// are compiled again.
    pub fn open(&self) -> Result<(Device, Kept)> {
        let device = self.device.open()?;
        device.set_memory_budget(self.memory_budget.map(|mib| mib << 20));
        let report = device.report();
        let plain = |c: char| if c.is_ascii_alphanumeric() { c } else { '-' };
        let name = format!("{} {}", report.name, report.driver);
        let name: String = name.chars().map(plain).collect();
        let file = cache::folder().map(|folder| folder.join(format!("{name}.pipelines")));
        if let Some(data) = file.as_deref().and_then(cache::read) {
            // Data of another driver is ignored, and a damaged file refused.
            let _ = device.add_pipeline_cache(&data);
        }
        Ok((device, Kept { file }))
    }

    /// Warnings about the scene, and about options that the method ignores.
    pub fn warnings(&self, scene: &Scene) -> Vec<String> {
        let mut found = revmap_files::warnings(scene, self.size.0, self.size.1);
        let given = [
            ("--max-steps", self.max_steps.is_some()),
            ("--map-rows", self.map_rows.is_some()),
            ("--map-source", self.map_source.is_some()),
            ("--map-format", self.map_format != MapFormat::R32),
            ("--solver", self.solver != Method::DEFAULT),
            ("--tolerance", self.tolerance.is_some()),
            ("--device", self.device.name().is_some()),
        ];
        let (who, reads): (String, &[&str]) = match self.stage {
            Tracing::Reference => ("--stage reference".to_owned(), &[]),
            Tracing::Device(_) => (format!("--solver {}", self.solver), read_by(self.solver)),
        };
        let idle = given
            .iter()
            .filter(|(name, is)| *is && !reads.contains(name));
        found.extend(idle.map(|(name, _)| format!("{name}: {who} makes no use of it")));
        found
    }
}

/// What a picture shows beside the scene, and plain colours
#[derive(Args, Clone, Debug)]
pub struct Surroundings {
    /// Puts a ground below the objects that fades into a plain background, and replaces the lights:
    /// a soft one from the upper left of the camera and one from behind. A profile fills four
    /// fifths of the picture; a scene keeps its camera
    #[arg(long)]
    pub studio: bool,
    /// Colour of the objects where no colour map covers it; as CSS writes it, such as orange,
    /// "#e0a030" or "rgb(224 160 48)"
    #[arg(long, value_name = "COLOR", value_parser = opaque_color)]
    color: Option<[f32; 3]>,
    /// Colour of the ground of --studio [default: that of --background, else a light grey]
    #[arg(long, value_name = "COLOR", requires = "studio", value_parser = opaque_color)]
    ground: Option<[f32; 3]>,
    /// Colour of the background. There is no ground on one with transparency, such as transparent
    #[arg(long, value_name = "COLOR", value_parser = css_color)]
    background: Option<[f32; 4]>,
}

impl Surroundings {
    /// Assignments to keys of the scene: those of these options, then `sets`, which say more. Refuses
    /// a key that the studio replaces.
    pub fn sets(&self, file: &SceneFile, sets: &[String]) -> Result<Vec<String>> {
        for set in sets {
            let key = set.split('=').next().unwrap_or_default().trim();
            let root = key.split('.').next().unwrap_or_default();
            let of_studio = ["light", "shadow", "ambient", "environment", "background"];
            if self.studio && of_studio.contains(&root) {
                let message = "is replaced by --studio; leave one of the two out";
                return Err(usage(key, message));
            }
        }
        let color = self.color.into_iter().flat_map(|color| {
            let set = move |n| format!("object.{n}.color={color:?}");
            (0..file.objects()).map(set)
        });
        let background = self.background.map(|color| format!("background={color:?}"));
        let own = color.chain(background);
        Ok(own.chain(sets.iter().cloned()).collect())
    }

    /// The studio, if the options ask for one.
    pub fn studio(&self) -> Result<Option<Studio>> {
        let transparent = self.background.is_some_and(|[.., alpha]| alpha < 1.0);
        if self.ground.is_some() && transparent {
            let message = "has no background to fade into; give --background without transparency";
            return Err(usage("--ground", message));
        }
        let studio = || Studio::new(self.ground, self.background);
        self.studio.then(studio).transpose()
    }

    /// The scene of a file without the studio, and the studio. Its camera is chosen for a profile
    /// in place of a scene.
    pub fn read(
        &self,
        file: &mut SceneFile,
        sets: &[String],
        aspect: f64,
    ) -> Result<(Scene, Option<Studio>)> {
        let mut studio = self.studio()?;
        let sets = self.sets(file, sets)?;
        let mut scene = file.scene(&sets)?;
        if let Some(studio) = studio.as_mut().filter(|_| file.chooses_camera(&sets)) {
            studio.frame(&[(scene.clone(), 0.0)], aspect);
            studio.place_camera(&mut scene);
        }
        Ok((scene, studio))
    }
}

/// A colour of CSS: linear RGB with alpha.
fn css_color(text: &str) -> std::result::Result<[f32; 4], String> {
    let wanted = "is no colour; write it as in orange, \"#e0a030\" or \"rgb(224 160 48)\"";
    revmap_files::css_color(text).ok_or_else(|| wanted.to_owned())
}

fn opaque_color(text: &str) -> std::result::Result<[f32; 3], String> {
    match css_color(text)? {
        [r, g, b, 1.0] => Ok([r, g, b]),
        _ => Err("is transparent; give a colour that is not".to_owned()),
    }
}

/// The file of a device's pipelines.
pub struct Kept {
    file: Option<PathBuf>,
}

impl Kept {
    /// Stores the compiled pipelines, if there are any.
    pub fn save(&self, device: &Device) {
        let (Some(file), true) = (&self.file, device.pipelines_compiled() > 0) else {
            return;
        };
        let Ok(data) = device.pipeline_cache_data() else {
            return;
        };
        if cache::read(file).as_deref() != Some(&data) {
            cache::write(file, &data);
        }
    }
}

/// The options that a method reads.
fn read_by(method: Method) -> &'static [&'static str] {
    const OF_MAPS: [&str; 6] = [
        "--solver",
        "--device",
        "--map-rows",
        "--max-steps",
        "--map-source",
        "--map-format",
    ];
    match method {
        _ if method.reads_map() => &OF_MAPS,
        _ if method.reads_own_table() && method.default_steps(false) > 1 => &OF_MAPS[..4],
        _ if method.reads_own_table() => &OF_MAPS[..3],
        Method::Search(_) | Method::Floor => &["--solver", "--device", "--tolerance"],
        Method::Mesh { .. } | Method::MeshWithin { .. } => &OF_MAPS[..2],
    }
}

/// A parser of one of a few names.
pub fn named<T: Copy + Send + Sync + 'static, const N: usize>(
    names: &'static [(&'static str, T); N],
) -> impl TypedValueParser<Value = T> {
    let listed = |name: &'static str| PossibleValue::new(name).hide(name == ALIAS);
    let all = names.iter().map(|(name, _)| listed(name));
    PossibleValuesParser::new(all).try_map(move |name: String| {
        let found = names.iter().find(|(known, _)| *known == name);
        found.map(|&(_, value)| value).ok_or("not known")
    })
}

/// A parser of a search's name, or of a mesh's tessellation.
#[derive(Clone)]
pub struct MethodParser;

impl TypedValueParser for MethodParser {
    type Value = Method;

    fn parse_ref(
        &self,
        command: &clap::Command,
        argument: Option<&clap::Arg>,
        value: &std::ffi::OsStr,
    ) -> std::result::Result<Method, clap::Error> {
        let own = |text: &str| {
            text.starts_with("mesh") || text == Method::Floor.name() || folder::is_named(text)
        };
        if value.to_str().is_some_and(own) {
            let method = |text: &str| text.parse::<Method>();
            return method.parse_ref(command, argument, value);
        }
        let listed = self.possible_values().into_iter().flatten();
        let alias = PossibleValue::new(ALIAS).hide(true);
        let known = PossibleValuesParser::new(listed.chain([alias]));
        known.parse_ref(command, argument, value)?;
        named(&SOLVERS).parse_ref(command, argument, value)
    }

    fn possible_values(&self) -> Option<Box<dyn Iterator<Item = PossibleValue> + '_>> {
        let names = SOLVERS.iter().map(|(name, _)| *name);
        let names = names.filter(|name| *name != ALIAS);
        let all = names.chain([
            "mesh:PIXELSpx",
            "mesh:SEGMENTSxRINGS",
            Method::Floor.name(),
            "FOLDER",
        ]);
        Some(Box::new(all.map(PossibleValue::new)))
    }
}

/// The searches among methods.
///
/// # Errors
/// [`ErrorKind::Usage`](revmap::error::ErrorKind::Usage) for a mesh and for the floor.
pub fn searches(methods: &[Method]) -> Result<Vec<Solver>> {
    let search = |method: &Method| {
        method
            .solver()
            .ok_or_else(|| usage("--solver", format!("{method} is no search; give searches")))
    };
    methods.iter().map(search).collect()
}

/// A number above 0.
pub fn positive(text: &str) -> std::result::Result<f64, String> {
    match text.parse::<f64>() {
        Ok(x) if x.is_finite() && x > 0.0 => Ok(x),
        _ => Err("give a number above 0".to_owned()),
    }
}

/// A tolerance in pixels.
pub fn tolerance(text: &str) -> std::result::Result<Tolerance, String> {
    text.parse().map_err(|e: revmap::Error| e.message)
}

/// `WIDTHxHEIGHT`, each from 1 to [`MAX_SIDE`].
pub fn size(text: &str) -> std::result::Result<(u32, u32), String> {
    let sides = text.split_once(['x', 'X']).ok_or_else(|| {
        let numbers = text
            .split([',', '*', ':', ' '])
            .filter(|n| n.parse::<u32>().is_ok());
        match numbers.collect::<Vec<_>>()[..] {
            [width, height] => format!("write it as {width}x{height}"),
            _ => "write it as 800x600".to_owned(),
        }
    })?;
    let side = |side: &str, what: &str| match side.parse::<i64>() {
        Ok(n) if (1..=i64::from(MAX_SIDE)).contains(&n) => Ok(n as u32),
        Ok(n) => Err(format!("the {what} is {n}; give 1 to {MAX_SIDE}")),
        Err(_) => Err(format!(
            "the {what} {side:?} is no number of pixels; write it as 800x600"
        )),
    };
    Ok((side(sides.0, "width")?, side(sides.1, "height")?))
}

#[cfg(test)]
mod tests {
    use super::*;
    use revmap::settings::name_of;

    #[test]
    fn the_default_solver_is_told_by_its_own_name() {
        assert_eq!(name_of(&SOLVERS, &SOLVERS[0].1), Method::DEFAULT.name());
    }
}
