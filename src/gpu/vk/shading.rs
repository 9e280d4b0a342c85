//! A host's shading on a device: its checks, and the layout of pipelines with the host's set.

use crate::error::{Error, ErrorKind, Result};
use crate::gpu::vk::call::Call;
use crate::gpu::vk::descriptors::SETS;
use crate::gpu::vk::output::Output;
use crate::maps::MapFormat;
use crate::settings::{DrawStage, Plane, Planes, SearchSettings, Solver};
use crate::shading::Shading;
use ash::vk;
use std::sync::Arc;

/// The number of the host's descriptor set.
pub(crate) const HOST_SET: u32 = SETS.len() as u32;

/// A host's function of shading, and the layout of the descriptor set that the function reads.
#[derive(Clone, Debug)]
pub struct HostShading {
    /// The function.
    pub shading: Arc<Shading>,
    /// The layout of set 3, for the stage of the shading; null if the function reads no set.
    pub set_layout: vk::DescriptorSetLayout,
}

impl HostShading {
    /// Returns an error for an output or a search that the function does not shade, and for a function
    /// that does not fit the sets.
    pub(crate) fn check(&self, output: &Output, settings: &SearchSettings) -> Result<()> {
        let usage =
            |key: &str, message: String| Err(Error::new(ErrorKind::Usage, message).at_key(key));
        let (stage, name) = match output {
            Output::Pass(_) => (DrawStage::Fragment, "a pass"),
            Output::Compute(_) => (DrawStage::Compute, "a compute target"),
        };
        if self.shading.stage() != stage {
            let (own, stage) = (self.shading.stage().name(), stage.name());
            let message = format!("is of the stage {own}, and {name} needs {stage}; compile it so");
            return usage("shading", message);
        }
        let has_color = match output.planes() {
            Planes::Color => true,
            Planes::List(list) => list.has(Plane::Color),
            Planes::All | Planes::Depth { .. } => false,
        };
        if !has_color {
            let message =
                "a host's function shades colour, or a list with colour; give one of them";
            return usage("planes", message.into());
        }
        let exact = matches!(
            settings.solver,
            Solver::Exact | Solver::Quadric | Solver::Live
        );
        if !exact || settings.map_format == MapFormat::Rgba8 {
            let message = "a host's function shades hits of exact, quadric or live, with maps in r16 or r32; give one of them";
            return usage("solver", message.into());
        }
        for (set, binding) in self.shading.bindings() {
            let known = SETS.get(set as usize).map(|own| binding < own.len() as u32);
            if set > HOST_SET || known == Some(false) {
                let message = format!("reads set {set}, binding {binding}; declare data in set 3");
                return usage("shading", message);
            }
            if set == HOST_SET && self.set_layout == vk::DescriptorSetLayout::null() {
                return usage(
                    "set_layout",
                    "is null, and the shading reads set 3; give one".into(),
                );
            }
        }
        Ok(())
    }
}

/// A host's shading with the layout of its pipelines.
pub(crate) struct BoundShading {
    pub shading: Arc<Shading>,
    pub layout: vk::PipelineLayout,
    raw: ash::Device,
}

impl BoundShading {
    /// `sets`: layouts of the library's sets. `pushed`: range of its push constants.
    pub fn new(
        raw: &ash::Device,
        host: &HostShading,
        sets: &[vk::DescriptorSetLayout],
        pushed: vk::PushConstantRange,
    ) -> Result<Self> {
        let mut sets = sets.to_vec();
        sets.extend(Some(host.set_layout).filter(|own| *own != vk::DescriptorSetLayout::null()));
        let pushed = [pushed];
        let info = vk::PipelineLayoutCreateInfo::default()
            .set_layouts(&sets)
            .push_constant_ranges(&pushed);
        // SAFETY: a plain creation, destroyed in Drop.
        let layout =
            unsafe { raw.create_pipeline_layout(&info, None) }.call("vkCreatePipelineLayout")?;
        Ok(Self {
            shading: host.shading.clone(),
            layout,
            raw: raw.clone(),
        })
    }
}

impl Drop for BoundShading {
    fn drop(&mut self) {
        // SAFETY: the renderer's frames are done, and its pipelines need no layout.
        unsafe { self.raw.destroy_pipeline_layout(self.layout, None) };
    }
}
