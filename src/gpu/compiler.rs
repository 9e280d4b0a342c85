//! What a driver's compiler says of the pipelines: registers, spills, instructions.
//!
//! This makes an instance, a device and pipelines, and no image, memory or fence. Some drivers
//! compile for GPUs that are not there and can do nothing else, not even destroy their device: it
//! is left to the end of the process.

mod techniques;

use super::call::Call;
use super::device::create;
use super::instance::{Instance, into_device};
use super::output::{DepthOrder, Output, PassFormats, PassKind};
use super::pipelines::DeviceConstants;
use super::pipelines::Pipelines;
use super::report::{DeviceReport, candidates, choose, text, variable};
use crate::error::{Error, Result, Stage};
use crate::settings::{DrawStage, Planes, Solver};
use crate::shader::generated::{CUT_ANY, CUT_SOLID};
use crate::shader::{Dispatch, Kind, Variant, listed};
use ash::{khr, vk};
use std::mem::ManuallyDrop;
use techniques::{Technique, techniques};

/// One shader of a pipeline, as compiled.
#[derive(Clone, Debug)]
pub struct CompiledShader {
    /// The technique that a scene uses, e.g. `textured`.
    pub technique: &'static str,
    /// Where rays are traced.
    pub stage: DrawStage,
    /// The search.
    pub solver: Solver,
    /// What is drawn or dispatched: `hull`, `box`, `rectangle`, ... In compute, one object alone or
    /// one of several, whose depths are compared.
    pub path: String,
    /// The driver's name of the shader: `vertex`, `fragment`, `compute`.
    pub shader: String,
    /// The SPIR-V module that it was compiled from.
    pub module: String,
    /// Invocations in a subgroup.
    pub subgroup_size: u32,
    /// What the driver says, in its order and by its names; hashes are left out.
    pub statistics: Vec<(String, f64)>,
}

/// Compiles the pipelines of each technique, by these stages and searches, and asks the driver
/// about each. A pipeline that several rows would use is listed once, where it is used first.
///
/// The device is chosen as by [`Device::open`](super::Device::open). It is not destroyed.
///
/// # Errors
/// [`Stage::Device`] as of `open`, and for a driver without
/// `VK_KHR_pipeline_executable_properties`; [`Stage::Draw`] of Vulkan.
pub fn compiled_shaders(
    choice: Option<&str>,
    stages: &[DrawStage],
    solvers: &[Solver],
) -> Result<(DeviceReport, Vec<CompiledShader>)> {
    let compiler = Compiler::open(choice)?;
    let mut rows = Vec::new();
    let mut known = Vec::new();
    for technique in techniques()? {
        for &stage in stages {
            for &solver in solvers {
                for (variant, kind) in technique.pipelines(stage, solver) {
                    let drawn =
                        compiler.clips || stage == DrawStage::Compute || !variant.is_cut(kind);
                    if !drawn || known.contains(&(variant, kind)) {
                        continue;
                    }
                    known.push((variant, kind));
                    rows.extend(compiler.shaders(&technique, (stage, solver), (variant, kind))?);
                }
            }
        }
    }
    Ok((compiler.report.clone(), rows))
}

/// A device that compiles.
struct Compiler {
    report: DeviceReport,
    /// As [`Candidate::clips`](super::report::Candidate::clips).
    clips: bool,
    asked: khr::pipeline_executable_properties::Device,
    // Never destroyed.
    pipelines: ManuallyDrop<Pipelines>,
    _instance: ManuallyDrop<Instance>,
}

impl Compiler {
    fn open(choice: Option<&str>) -> Result<Self> {
        let instance = ManuallyDrop::new(Instance::from_environment()?);
        let variable = variable();
        let chosen = choose(candidates(&instance)?, choice.or(variable.as_deref()))?;
        let extension = khr::pipeline_executable_properties::NAME;
        if !chosen.offers(extension) {
            let (name, extension) = (&chosen.report.name, extension.to_string_lossy());
            return Err(Error::new(
                Stage::Device,
                format!(
                    "{name} lacks {extension}, by which its compiler is asked; choose another with --device"
                ),
            ));
        }
        let mut info = vk::PhysicalDevicePipelineExecutablePropertiesFeaturesKHR::default()
            .pipeline_executable_info(true);
        let raw = create(&instance, &chosen, &[extension], Some(&mut info))?;
        let constants = DeviceConstants::of(&chosen);
        let pipelines = Pipelines::new(raw.clone(), None, constants).map_err(into_device)?;
        let asked = khr::pipeline_executable_properties::Device::new(&instance.raw, &raw);
        Ok(Self {
            clips: chosen.clips(),
            report: chosen.report,
            asked,
            pipelines: ManuallyDrop::new(pipelines.capturing_statistics()),
            _instance: instance,
        })
    }

    /// Where a stage draws.
    fn output(&self, stage: DrawStage, planes: Planes) -> Result<Output> {
        Ok(match stage {
            DrawStage::Compute => Output::Compute(planes),
            DrawStage::Fragment => Output::Pass(PassFormats {
                begun: PassKind::RenderPass {
                    pass: self.pipelines.own_pass(planes, false)?,
                    subpass: 0,
                },
                samples: 1,
                depth: DepthOrder::Normal,
                planes,
            }),
        })
    }

    /// The shaders of one pipeline.
    fn shaders(
        &self,
        technique: &Technique,
        (stage, solver): (DrawStage, Solver),
        (variant, kind): (Variant, Kind),
    ) -> Result<Vec<CompiledShader>> {
        let output = self.output(stage, technique.planes)?;
        let pipeline = self.pipelines.get(variant, kind, &output, 0)?;
        let info = vk::PipelineInfoKHR::default().pipeline(pipeline);
        // SAFETY: the pipeline was made with statistics captured, and is never destroyed.
        let executables =
            unsafe { self.asked.get_pipeline_executable_properties(&info) }.call(EXECUTABLES)?;
        let mut shaders = Vec::new();
        for (executable, index) in executables.iter().zip(0..) {
            let info = vk::PipelineExecutableInfoKHR::default()
                .pipeline(pipeline)
                .executable_index(index);
            // SAFETY: as above; the index is that of an executable.
            let said = unsafe { self.asked.get_pipeline_executable_statistics(&info) }
                .call("vkGetPipelineExecutableStatisticsKHR")?;
            let vertices = executable.stages.contains(vk::ShaderStageFlags::VERTEX);
            let module = match variant.vertices(kind) {
                Some(module) if vertices => module,
                _ => variant.module(kind),
            };
            shaders.push(CompiledShader {
                technique: technique.name,
                stage,
                solver,
                path: path(variant, kind),
                shader: stage_name(&text(&executable.name)),
                module: listed(&module).unwrap_or(module).name(),
                subgroup_size: executable.subgroup_size,
                statistics: said.iter().filter_map(statistic).collect(),
            });
        }
        Ok(shaders)
    }
}

const EXECUTABLES: &str = "vkGetPipelineExecutablePropertiesKHR";

/// Versions of a driver say `Fragment Shader` or `fragment`.
fn stage_name(name: &str) -> String {
    let name = name.to_lowercase();
    name.strip_suffix(" shader").unwrap_or(&name).to_owned()
}

fn path(variant: Variant, kind: Kind) -> String {
    let several = variant.depth_test != 0;
    let name = match (kind, variant.dispatch) {
        (Kind::Box, _) => "box",
        (Kind::Hull, _) => "hull",
        (Kind::Sides, _) if variant.cut == CUT_SOLID => "solid sides",
        (Kind::Sides, _) => "sides",
        (Kind::ConvexHull, _) => "convex hull",
        (Kind::Spots, Dispatch::Beams) => "squares of one copy in spans",
        (Kind::Spots, _) => "squares of one copy",
        (Kind::Bins, _) => "bins",
        (Kind::Beam, _) => "list of tiles",
        (Kind::List, _) => "lists of patches",
        (Kind::ListCopies, _) => "lists of patches of copies",
        (Kind::Listed, _) | (Kind::Compute, Dispatch::Lists) => {
            let of = match (variant.alone != 0, several) {
                (true, _) => " of bins of one copy",
                (false, true) => " of several",
                (false, false) => "",
            };
            return format!("tiles of {} patches{of}", variant.list_length);
        }
        (Kind::Compute, Dispatch::Rectangle) if variant.cut != CUT_ANY => {
            match (variant.cut == CUT_SOLID, several) {
                (true, true) => "tiles of cuts of several",
                (true, false) => "tiles of cuts",
                (false, true) => "tiles with cuts of several",
                (false, false) => "tiles with cuts",
            }
        }
        (Kind::Compute, Dispatch::Rectangle) if several => "rectangle of several",
        (Kind::Compute, Dispatch::Rectangle) => "rectangle",
        (Kind::Compute, Dispatch::Bins) => "bins",
        (Kind::Compute, Dispatch::Beams) if several => "tiles of several",
        (Kind::Compute, Dispatch::Beams) => "tiles",
    };
    name.to_owned()
}

/// A number by its name, unless it is a hash.
fn statistic(said: &vk::PipelineExecutableStatisticKHR<'_>) -> Option<(String, f64)> {
    use vk::PipelineExecutableStatisticFormatKHR as F;
    let name = text(&said.name);
    // SAFETY: the format says which of the values is there.
    #[allow(clippy::cast_precision_loss)]
    let value = unsafe {
        match said.format {
            F::BOOL32 => f64::from(said.value.b32),
            F::INT64 => said.value.i64 as f64,
            F::UINT64 => said.value.u64 as f64,
            F::FLOAT64 => said.value.f64,
            _ => return None,
        }
    };
    (!name.to_lowercase().contains("hash")).then_some((name, value))
}
