//! Statistics of a driver's compiler on the pipelines: registers, spills, instructions. Only the
//! program's report uses them.
//!
//! This module makes an instance, a device and pipelines, and no image, memory or fence. Some
//! drivers compile for GPUs that are not there. Such drivers can do nothing else, not even destroy
//! their device: it is left to the end of the process.

use crate::error::{Error, ErrorKind, Result};
use crate::gpu::device::create;
use crate::gpu::device::instance::Instance;
use crate::gpu::device::report::{DeviceReport, choose, text};
use crate::gpu::vk::call::Call;
use crate::gpu::vk::output::{Output, PassFormats, PassKind};
use crate::gpu::vk::pipelines::Pipelines;
use crate::maps::MapFormat;
use crate::plan::Conditions;
use crate::scene::{Clip, Lighting, Object, Shadow};
use crate::settings::{DrawStage, Plane, Planes, SearchSettings, Solver};
use crate::shader::{
    Demands, Drawn, HostLook, Kind, Lights, Outside, ShadowCasters, Speciality, Technique, Variant,
};
use ash::{khr, vk};
use std::mem::ManuallyDrop;

/// The properties of a drawing that pipelines depend on.
#[derive(Clone, Debug)]
pub struct Look {
    /// The object.
    pub object: Object,
    /// The lighting of the object.
    pub lighting: Lighting,
    /// The format of the object's map.
    pub format: MapFormat,
    /// The planes that are stored.
    pub planes: Planes,
}

/// A pipeline.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PipelineChoice(Variant, Kind);

impl PipelineChoice {
    /// The name of the draw or dispatch: `cells`, `boxes`, `tiles of 8 patches`, ...
    #[must_use]
    pub fn path(&self) -> String {
        let Self(variant, kind) = self;
        let path = match kind {
            Kind::TilePatches(length) => format!("tiles of {length} patches"),
            _ => kind.label().to_string_lossy().replace("revmap ", ""),
        };
        match *variant == Variant::general(variant.technique).of_kind(*kind) {
            true => format!("{path}, general"),
            false => path,
        }
    }
}

/// One shader of a pipeline, as compiled.
#[derive(Clone, Debug)]
pub struct Executable {
    /// The driver's name of the shader: `vertex`, `fragment`, `compute`.
    pub shader: String,
    /// The SPIR-V module that the shader was compiled from. For a search of another crate, the
    /// module that was requested of it.
    pub module: String,
    /// Invocations in a subgroup.
    pub subgroup_size: u32,
    /// The driver's statistics, in its order and by its names; hashes are left out.
    pub statistics: Vec<(String, f64)>,
}

/// A device that compiles, and is never destroyed.
pub struct PipelineCompiler {
    /// The device.
    pub report: DeviceReport,
    /// The conditions of a device with every capability.
    conditions: Conditions,
    queries: khr::pipeline_executable_properties::Device,
    // Never destroyed.
    pipelines: ManuallyDrop<Pipelines>,
    _instance: ManuallyDrop<Instance>,
}

impl PipelineCompiler {
    /// Opens the device, chosen as by [`Device::open`](crate::gpu::Device::open).
    ///
    /// # Errors
    /// Same as [`Device::open`](crate::gpu::Device::open); [`ErrorKind::Unsupported`] for a driver
    /// without `VK_KHR_pipeline_executable_properties`; errors of Vulkan calls.
    pub fn open(choice: Option<&str>) -> Result<Self> {
        let instance = ManuallyDrop::new(Instance::from_environment()?);
        let chosen = choose(&instance, choice)?;
        let extension = khr::pipeline_executable_properties::NAME;
        if !chosen.offers(extension) {
            let (name, extension) = (&chosen.report.name, extension.to_string_lossy());
            let message =
                format!("{name} lacks {extension}, by which its compiler reports; choose another");
            return Err(Error::new(ErrorKind::Unsupported, message).at_key("device"));
        }
        let mut info = vk::PhysicalDevicePipelineExecutablePropertiesFeaturesKHR::default()
            .pipeline_executable_info(true);
        let raw = create(&instance, &chosen, &[extension], Some(&mut info))?;
        let constants = chosen.constants();
        let mut pipelines = Pipelines::new(raw.clone(), None, constants)?;
        pipelines.flags = vk::PipelineCreateFlags::CAPTURE_STATISTICS_KHR;
        let queries = khr::pipeline_executable_properties::Device::new(&instance.raw, &raw);
        Ok(Self {
            conditions: Conditions {
                passes_cells: true,
                subgroup_size: chosen.subgroup_size,
                group_invocations: chosen.properties.limits.max_compute_work_group_invocations,
                most_storage: u32::MAX,
                ..Conditions::default()
            },
            report: chosen.report,
            queries,
            pipelines: ManuallyDrop::new(pipelines),
            _instance: instance,
        })
    }

    /// The pipelines that draw a look.
    #[must_use]
    pub fn pipelines(&self, look: &Look, stage: DrawStage, solver: Solver) -> Vec<PipelineChoice> {
        let of_host = !matches!(look.planes, Planes::Color | Planes::All);
        let exact = solver.external().is_none();
        let listed = matches!(look.planes, Planes::List(_));
        if (of_host && (stage == DrawStage::Compute || !exact))
            || (listed && look.format == MapFormat::Rgba8)
            || (look.format == MapFormat::Rgba8 && !solver.reads_map())
        {
            return Vec::new();
        }
        let settings = SearchSettings {
            solver,
            map_format: look.format,
            ..SearchSettings::default()
        };
        let (lighting, object) = (&look.lighting, &look.object);
        let demands = Demands {
            settings: &settings,
            planes: look.planes,
            host_shades: false,
            lighting,
        };
        let (casters, host) = (ShadowCasters::default(), HostLook::default());
        let technique = Technique::new(&demands, solver, object, casters, host);
        let conditions = Conditions {
            compute: stage == DrawStage::Compute,
            takes_patches: settings.takes_patches(),
            casts: lighting.shadow != Shadow::Off,
            ..self.conditions
        };
        let may_cut = object.clip == Clip::Box || object.axis_offset() != [0.0; 2];
        let mut all = Vec::new();
        let kinds = conditions.kinds(&technique).into_iter();
        for kind in kinds.filter(|kind| may_cut || *kind != Kind::CutCells) {
            let general = Variant::general(technique);
            let mut add = |variant: Variant| {
                let choice = PipelineChoice(variant.of_kind(kind), kind);
                if !all.contains(&choice) {
                    all.push(choice);
                }
            };
            for depths in [false, true] {
                add(Variant {
                    speciality: Speciality {
                        lights: match conditions.casts {
                            true => Lights::Any,
                            false => Lights::of(lighting.lights.len()),
                        },
                        drawn: if depths {
                            Drawn::OneObject
                        } else {
                            Drawn::OneCopy
                        },
                        outside: if may_cut { Outside::None } else { Outside::All },
                        depths,
                        single: !depths, // both forms of cells are listed
                    },
                    ..general
                });
            }
            // Searches for comparison are timed by their special forms alone.
            if exact {
                add(general);
            }
        }
        all
    }

    /// The output that a stage draws into.
    fn output(stage: DrawStage, planes: Planes) -> Output {
        match stage {
            DrawStage::Compute => Output::Compute(planes),
            DrawStage::Fragment => Output::Pass(PassFormats::new(
                PassKind::SingleSubpass {
                    color: color_formats(planes),
                    depth: vk::Format::D32_SFLOAT,
                },
                planes,
            )),
        }
    }

    /// Compiles a pipeline, and queries the driver's statistics of its shaders.
    ///
    /// # Errors
    /// Errors of Vulkan calls.
    pub fn compile(
        &self,
        choice: PipelineChoice,
        stage: DrawStage,
        planes: Planes,
    ) -> Result<Vec<Executable>> {
        let PipelineChoice(variant, kind) = choice;
        let output = Self::output(stage, planes);
        let owner = self.pipelines.owner(&output, None)?;
        let pipeline = self.pipelines.get(variant, kind, &owner)?;
        let info = vk::PipelineInfoKHR::default().pipeline(pipeline);
        // SAFETY: the pipeline was made with statistics captured, and is never destroyed.
        let executables = unsafe { self.queries.get_pipeline_executable_properties(&info) }
            .call("vkGetPipelineExecutablePropertiesKHR")?;
        let mut shaders = Vec::new();
        for (executable, index) in executables.iter().zip(0..) {
            let info = vk::PipelineExecutableInfoKHR::default()
                .pipeline(pipeline)
                .executable_index(index);
            // SAFETY: as above; the index is that of an executable.
            let said = unsafe { self.queries.get_pipeline_executable_statistics(&info) }
                .call("vkGetPipelineExecutableStatisticsKHR")?;
            let vertices = executable.stages.contains(vk::ShaderStageFlags::VERTEX);
            let module = match variant.vertices(kind) {
                Some(module) if vertices => module,
                _ => variant.module(kind),
            };
            shaders.push(Executable {
                shader: stage_name(&text(executable.name_as_c_str())),
                module: match variant.technique.external {
                    Some(external) if !vertices => external.name(&module),
                    _ => module.name(),
                },
                subgroup_size: executable.subgroup_size,
                statistics: said.iter().filter_map(statistic).collect(),
            });
        }
        Ok(shaders)
    }
}

/// Formats of colour attachments, in order of location.
fn color_formats(planes: Planes) -> Vec<vk::Format> {
    use vk::Format as F;
    match planes {
        Planes::Color => vec![F::R8G8B8A8_SRGB],
        Planes::Depth { .. } => Vec::new(),
        Planes::All => vec![F::R32G32B32A32_SFLOAT; 4],
        Planes::List(list) => {
            let format = |plane: &Plane| match plane {
                Plane::Color | Plane::BaseColor | Plane::Normal => F::R16G16B16A16_SFLOAT,
                Plane::OctahedralNormal | Plane::Material | Plane::Motion => F::R16G16_SFLOAT,
                Plane::Identity => F::R32G32_UINT,
            };
            list.planes().iter().map(format).collect()
        }
    }
}

/// The stage in lower case: versions of a driver write `Fragment Shader` or `fragment`.
fn stage_name(name: &str) -> String {
    let name = name.to_lowercase();
    name.strip_suffix(" shader").unwrap_or(&name).to_owned()
}

/// A number with its name; `None` for a hash.
fn statistic(said: &vk::PipelineExecutableStatisticKHR<'_>) -> Option<(String, f64)> {
    use vk::PipelineExecutableStatisticFormatKHR as F;
    let name = text(said.name_as_c_str());
    // SAFETY: the format says which of the values is valid.
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
