//! Checks of an output: what the device draws into, and the memory that compute writes to.

use crate::error::{Error, ErrorKind, Result};
use crate::gpu::device::Shared;
use crate::gpu::vk::call::kind_of;
use crate::gpu::vk::output::{ComputeTarget, Output, PassFormats, PassKind};
use crate::maps::MapFormat;
use crate::settings::{Plane, Planes, SearchSettings, Solver};
use ash::vk;

impl Output {
    /// Returns an error for an output that the device or the solver cannot draw.
    pub(crate) fn check(&self, device: &Shared, settings: &SearchSettings) -> Result<()> {
        let exact = matches!(
            settings.solver,
            Solver::Exact | Solver::Quadric | Solver::Live
        );
        let in_pass = matches!(self, Self::Pass(_));
        let all_outputs = matches!(self.planes(), Planes::Color | Planes::All);
        if !(all_outputs || in_pass && exact) {
            let message = "depth alone and lists are drawn in a pass, by exact, quadric or live; give one of them";
            return Err(usage("planes", message.into()));
        }
        if matches!(self.planes(), Planes::List(_)) && settings.map_format == MapFormat::Rgba8 {
            let message = "lists of planes read no map in rgba8; take r16 or r32";
            return Err(usage("map_format", message.into()));
        }
        let Self::Pass(pass) = self else {
            return Ok(());
        };
        if pass.planes == Planes::All
            && device.chosen.features.fragment_stores_and_atomics == vk::FALSE
        {
            return Err(Error::new(
                ErrorKind::Unsupported,
                "all planes in a pass need the feature fragmentStoresAndAtomics; enable it",
            ));
        }
        pass.check_samples(device)?;
        let (planes, most) = (
            pass.planes.attachments(),
            device.limits().max_color_attachments,
        );
        if planes > most as usize {
            let message = format!("{planes} planes; the device draws into {most} at once");
            return Err(Error::new(ErrorKind::Unsupported, message).at_key("planes"));
        }
        match &pass.begun {
            PassKind::RenderPass { pass: raw, .. } => pass.check_render_pass(device, *raw),
            PassKind::SingleSubpass { color, depth } => {
                pass.check_formats(device, color, *depth, vk::Format::UNDEFINED)
            }
            PassKind::Dynamic {
                color,
                depth,
                stencil,
            } => pass.check_formats(device, color, *depth, *stencil),
        }
    }

    /// Returns an error for a missing target, a target that does not fit, or an unneeded target.
    pub(crate) fn check_target(&self, target: Option<&ComputeTarget>) -> Result<()> {
        let compute = matches!(self, Self::Compute(_));
        let all = self.planes() == Planes::All;
        let Some(target) = target else {
            if compute || all {
                let message = "shaders write to a target; give one to set_compute_target";
                return Err(usage("target", message.into()));
            }
            return Ok(());
        };
        if !compute && !all {
            let message = "only attachments are drawn into; leave the target out";
            return Err(usage("target", message.into()));
        }
        if target.words == vk::Buffer::null() {
            return Err(usage("words", "the buffer is null; give one".into()));
        }
        let (count, wanted) = (target.images.len(), if compute && all { 4 } else { 0 });
        if count != wanted || target.images.contains(&vk::ImageView::null()) {
            let message = format!("{count} images; give {wanted}, none of them null");
            return Err(usage("images", message));
        }
        Ok(())
    }
}

/// Most views of a pass; every device with multiview has this many.
const MOST_VIEWS: u32 = 6;

impl PassFormats {
    fn check_samples(&self, device: &Shared) -> Result<()> {
        if self.sample_rays && device.chosen.features.sample_rate_shading == vk::FALSE {
            let message = "rays through samples need the feature sampleRateShading; enable it";
            return Err(Error::new(ErrorKind::Unsupported, message));
        }
        if !(1..=MOST_VIEWS).contains(&self.views) {
            let message = format!("{} views; give 1 to {MOST_VIEWS}", self.views);
            return Err(usage("views", message));
        }
        if !self.slope_bias.is_none() && !matches!(self.planes, Planes::Depth { .. }) {
            let message = "only depths alone have a bias for slopes; draw Planes::Depth";
            return Err(usage("slope_bias", message.into()));
        }
        if self.views > 1 && matches!(self.begun, PassKind::SingleSubpass { .. }) {
            let message = "a pass known by its formats has one view; give the render pass";
            return Err(usage("views", message.into()));
        }
        if self.views > 1 && self.planes == Planes::All {
            let message = "all planes are drawn for one view; give a list of planes";
            return Err(usage("views", message.into()));
        }
        if [1, 2, 4, 8].contains(&self.samples) {
            return Ok(());
        }
        let message = format!("{} samples; give 1, 2, 4 or 8", self.samples);
        Err(usage("samples", message))
    }

    /// Checks the handle and the sample count. Vulkan cannot return the formats of a render pass.
    fn check_render_pass(&self, device: &Shared, raw: vk::RenderPass) -> Result<()> {
        if raw == vk::RenderPass::null() {
            return Err(usage("pass", "the render pass is null; give one".into()));
        }
        let limits = device.limits();
        let colors = limits.framebuffer_color_sample_counts;
        self.check_counts(device, colors & limits.framebuffer_depth_sample_counts)
    }

    fn check_formats(
        &self,
        device: &Shared,
        color: &[vk::Format],
        depth: vk::Format,
        stencil: vk::Format,
    ) -> Result<()> {
        let wanted = self.planes.attachments();
        if color.len() != wanted {
            let (planes, count) = (self.planes, color.len());
            let message = format!("{count} attachments for the planes {planes:?}; give {wanted}");
            return Err(usage("color", message));
        }
        use vk::ImageUsageFlags as U;
        for (&format, number) in color.iter().zip(0..) {
            let plane = match self.planes {
                Planes::List(list) => list.planes()[number],
                _ => Plane::Color,
            };
            if format == vk::Format::UNDEFINED || has_depth(format) || has_stencil(format) {
                let message = format!("{format:?} holds no colours; give a format that does");
                return Err(usage("color", message));
            }
            if let Some(wanted) = misfit(plane, format) {
                let message = format!("{format:?} does not hold {plane:?}; give {wanted}");
                return Err(usage("color", message));
            }
            self.check_format(device, format, U::COLOR_ATTACHMENT)?;
        }
        if !has_depth(depth) {
            let message = format!("{depth:?} holds no depths; give a format that does");
            return Err(usage("depth", message));
        }
        self.check_format(device, depth, U::DEPTH_STENCIL_ATTACHMENT)?;
        if stencil == vk::Format::UNDEFINED {
            return Ok(());
        }
        if !has_stencil(stencil) || stencil != depth {
            let message =
                format!("{stencil:?} is not the depth's format, with stencil; give that, or none");
            return Err(usage("stencil", message));
        }
        Ok(())
    }

    fn check_format(
        &self,
        device: &Shared,
        format: vk::Format,
        usage: vk::ImageUsageFlags,
    ) -> Result<()> {
        // SAFETY: plain query of the device's own physical device.
        let found = unsafe {
            device
                .functions
                .get_physical_device_image_format_properties(
                    device.chosen.physical,
                    format,
                    vk::ImageType::TYPE_2D,
                    vk::ImageTiling::OPTIMAL,
                    usage,
                    vk::ImageCreateFlags::empty(),
                )
        };
        let found = found.map_err(|code| {
            let name = &device.chosen.report.name;
            let message = format!("{name} does not draw into {format:?} ({code:?})");
            Error::new(kind_of(code), message)
        })?;
        self.check_counts(device, found.sample_counts)
    }

    fn check_counts(&self, device: &Shared, counts: vk::SampleCountFlags) -> Result<()> {
        if counts.contains(vk::SampleCountFlags::from_raw(self.samples)) {
            return Ok(());
        }
        let name = &device.chosen.report.name;
        let message = format!("{name} has no {} samples; it has {counts:?}", self.samples);
        Err(Error::new(ErrorKind::Unsupported, message).at_key("samples"))
    }
}

fn usage(key: &str, message: String) -> Error {
    Error::new(ErrorKind::Usage, message).at_key(key)
}

fn has_depth(format: vk::Format) -> bool {
    use vk::Format as F;
    matches!(
        format,
        F::D16_UNORM | F::X8_D24_UNORM_PACK32 | F::D32_SFLOAT
    ) || (has_stencil(format) && format != F::S8_UINT)
}

fn has_stencil(format: vk::Format) -> bool {
    use vk::Format as F;
    matches!(
        format,
        F::S8_UINT | F::D16_UNORM_S8_UINT | F::D24_UNORM_S8_UINT | F::D32_SFLOAT_S8_UINT
    )
}

/// The kind of format that a plane needs, unless `format` is one. Reads the name of the format in
/// the specification, whose last part is the numeric type.
fn misfit(plane: Plane, format: vk::Format) -> Option<&'static str> {
    let name = format!("{format:?}");
    let is = |types: &[&str]| types.iter().any(|of| name.contains(of));
    let (fits, wanted) = match plane {
        Plane::Identity => (
            is(&["R32G32_UINT", "R32G32B32A32_UINT"]),
            "R32G32_UINT or R32G32B32A32_UINT",
        ),
        Plane::Normal => (
            is(&["_SNORM", "_SFLOAT"]) && is(&["B"]),
            "three signed channels or floats",
        ),
        Plane::OctahedralNormal => (
            is(&["_SNORM", "_SFLOAT"]) && is(&["G"]),
            "two signed channels or floats",
        ),
        Plane::Motion => (is(&["_SFLOAT"]) && is(&["G"]), "two floats"),
        Plane::Material => (
            !is(&["_UINT", "_SINT"]) && is(&["G"]),
            "two fractions or floats",
        ),
        Plane::Color | Plane::BaseColor => (!is(&["_UINT", "_SINT"]), "fractions or floats"),
    };
    (!fits).then_some(wanted)
}
