//! `revmap shaders`: the statistics of each pipeline from the driver's compiler.

mod techniques;

use super::options::{DeviceChoice, MethodParser, named, searches};
use super::output;
use clap::Args;
use revmap::gpu::DeviceReport;
use revmap::gpu::compiler::{Executable, Look, PipelineCompiler};
use revmap::settings::{DrawStage, Solver};
use revmap_bench::compare::submission::OneShader;
use revmap_bench::plan::method::Method;
use revmap_bench::report::table::Table;
use revmap_searches::{CIRCLE, folder};
use serde_json::{Map, Value, json};
use techniques::techniques;

/// Compiles what each stage, search and technique draws with, and prints what the driver's compiler
/// says of it: registers, spills, instructions
///
/// Nothing is drawn and no memory is allocated. The driver must offer
/// VK_KHR_pipeline_executable_properties. Mesa's RADV needs no GPU for it: the variable
/// RADV_FORCE_FAMILY names the one to compile for.
#[derive(Args)]
#[command(after_help = "Examples:\n  \
    revmap shaders --solver exact,live\n  \
    revmap shaders --stage compute --json | jq '.shaders[] | {technique, solver, statistics}'\n  \
    RADV_FORCE_FAMILY=navi21 revmap shaders --csv > navi21.csv")]
pub struct Shaders {
    /// Stages that trace rays
    #[arg(long, value_name = "STAGE,...", value_delimiter = ',', default_values = ["fragment", "compute"], value_parser = named(&DrawStage::NAMES))]
    stage: Vec<DrawStage>,
    /// The searches, and folders of other searches [default: all of revmap]
    #[arg(long, value_name = "NAME,...", value_delimiter = ',', value_parser = MethodParser)]
    solver: Vec<Method>,
    #[command(flatten)]
    device: DeviceChoice,
    /// Print one JSON value on standard output in place of a table
    #[arg(long)]
    json: bool,
    /// Comma-separated values on standard output in place of a table
    #[arg(long, conflicts_with = "json")]
    csv: bool,
}

/// The words of a shader.
const WORDS: [&str; 6] = ["technique", "stage", "solver", "path", "shader", "module"];

/// The statistics that the table shows if the driver has them; all statistics if it has none of
/// these.
const SHOWN: [&str; 9] = [
    "Subgroups per SIMD",
    "VGPRs",
    "Spilled VGPRs",
    "Spilled SGPRs",
    "Scratch size",
    "Instructions",
    "Code size",
    "Latency",
    "Inverse Throughput",
];

impl Shaders {
    pub fn run(self) -> revmap::Result<()> {
        let mut solvers = match self.solver.is_empty() {
            true => revmap_searches::ALL.to_vec(),
            false => searches(&self.solver)?,
        };
        // A folder with a fault costs the others nothing.
        let mut failed = Ok(());
        solvers.retain(|&solver| match folder::compile(solver) {
            Ok(()) => true,
            Err(error) => {
                output::warn(&format!("{solver} was left out: {error}"));
                failed = Err(error);
                false
            }
        });
        if solvers.is_empty() {
            return failed;
        }
        let compiler = PipelineCompiler::open(self.device.name())?;
        let shaders = compiled(&compiler, techniques()?, &self.stage, &solvers)?;
        let device = &compiler.report;
        if self.json {
            output::json(&as_json(device, &shaders));
            return Ok(());
        }
        let mut said: Vec<&str> = Vec::new();
        for (name, _) in shaders.iter().flat_map(|s| &s.executable.statistics) {
            if !said.contains(&name.as_str()) {
                said.push(name);
            }
        }
        let table = |names: &[&str], shown: &[&str], of_device: &[&str]| {
            let row = |shader: &CompiledShader| {
                let words = words(shader);
                let words = words[..shown.len()].iter().chain(of_device);
                let mut row: Vec<String> = words.map(|word| (*word).to_owned()).collect();
                row.splice(shown.len()..shown.len(), values(shader, names));
                row
            };
            let head = shown.iter().chain(names).copied();
            Table::new(head, shaders.iter().map(row).collect())
        };
        if self.csv {
            let mut table = table(&said, &WORDS, &[&device.name, &device.driver]);
            table.header.extend(["device", "driver"].map(String::from));
            table.csv().lines().for_each(output::result);
            return Ok(());
        }
        let known = SHOWN.into_iter().filter(|name| said.contains(name));
        let known: Vec<&str> = known.collect();
        let shown = if known.is_empty() { said } else { known };
        output::result(&format!("{}, {}\n", device.name, device.driver));
        let table = table(&shown, &WORDS[..5], &[]);
        let text = table.within(output::width(), "`--csv`");
        text.lines().for_each(output::result);
        Ok(())
    }
}

/// A shader, and the first technique, stage and search that it is compiled for.
struct CompiledShader {
    technique: &'static str,
    stage: DrawStage,
    solver: Solver,
    path: String,
    executable: Executable,
}

/// The shaders of a plain solid in both stages, by the searches that a submission measures.
///
/// # Errors
/// [`ErrorKind::Unsupported`](revmap::error::ErrorKind::Unsupported) if the driver's compiler reports
/// nothing.
pub fn plain(device: Option<&str>) -> revmap::Result<Vec<OneShader>> {
    let compiler = PipelineCompiler::open(device)?;
    let plain = techniques()?.into_iter().take(1).collect();
    let stages = DrawStage::NAMES.map(|(_, stage)| stage);
    let solvers = [CIRCLE, Solver::Live, Solver::Quadric, Solver::Exact];
    let shaders = compiled(&compiler, plain, &stages, &solvers)?.into_iter();
    let one = |shader: CompiledShader| OneShader {
        solver: shader.solver.name().to_owned(),
        stage: shader.stage.name().to_owned(),
        path: shader.path,
        shader: shader.executable.shader,
        subgroup_size: shader.executable.subgroup_size,
        statistics: shader.executable.statistics.into_iter().collect(),
    };
    Ok(shaders.map(one).collect())
}

/// The shaders of these techniques, by these stages and searches. The shaders of a shared pipeline
/// are listed once, at its first use.
fn compiled(
    compiler: &PipelineCompiler,
    techniques: Vec<(&'static str, Look)>,
    stages: &[DrawStage],
    solvers: &[Solver],
) -> revmap::Result<Vec<CompiledShader>> {
    let mut shaders = Vec::new();
    let mut known = Vec::new();
    for (technique, look) in techniques {
        for &stage in stages {
            for &solver in solvers {
                for choice in compiler.pipelines(&look, stage, solver) {
                    if known.contains(&choice) {
                        continue;
                    }
                    known.push(choice);
                    let executables = compiler.compile(choice, stage, look.planes)?;
                    shaders.extend(executables.into_iter().map(|executable| CompiledShader {
                        technique,
                        stage,
                        solver,
                        path: choice.path(),
                        executable,
                    }));
                }
            }
        }
    }
    Ok(shaders)
}

fn words(shader: &CompiledShader) -> [&str; 6] {
    [
        shader.technique,
        shader.stage.name(),
        shader.solver.name(),
        &shader.path,
        &shader.executable.shader,
        &shader.executable.module,
    ]
}

/// The statistics of these names; empty for those that are missing.
fn values(shader: &CompiledShader, names: &[&str]) -> Vec<String> {
    let text = |name: &&str| {
        let mut all = shader.executable.statistics.iter();
        let found = all.find(|(known, _)| known == name);
        found.map_or(String::new(), |(_, value)| value.to_string())
    };
    names.iter().map(text).collect()
}

fn as_json(device: &DeviceReport, shaders: &[CompiledShader]) -> Value {
    let shader = |shader: &CompiledShader| {
        let said = shader.executable.statistics.iter();
        let said = said.map(|(name, value)| (name.clone(), json!(value)));
        let named = WORDS.iter().zip(words(shader));
        let mut all: Map<_, _> = named
            .map(|(name, word)| ((*name).to_owned(), json!(word)))
            .collect();
        all.insert(
            "subgroup_size".to_owned(),
            json!(shader.executable.subgroup_size),
        );
        all.insert("statistics".to_owned(), said.collect());
        Value::Object(all)
    };
    json!({
        "device": device.name,
        "driver": device.driver,
        "shaders": shaders.iter().map(shader).collect::<Vec<_>>(),
    })
}
