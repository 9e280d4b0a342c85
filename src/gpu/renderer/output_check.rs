//! Checks of an output: what the device draws into, and the memory that compute writes to.

use crate::error::{Error, ErrorKind, Result};
use crate::gpu::device::Shared;
use crate::gpu::vk::call::kind_of;
use crate::gpu::vk::output::{ComputeTarget, Output, PassFormats, PassKind};
use crate::gpu::vk::render_pass::color_formats;
use crate::settings::{Planes, Solver};
use ash::vk;

impl Output {
    /// Returns an error for an output that the device or the solver cannot draw.
    pub(crate) fn check(&self, device: &Shared, solver: Solver) -> Result<()> {
        let exact = matches!(solver, Solver::Exact | Solver::Quadric | Solver::Live);
        let in_pass = matches!(self, Self::Pass(_));
        if matches!(self.planes(), Planes::Depth { .. }) && !(in_pass && exact) {
            let message =
                "depth alone is drawn in a pass, by exact, quadric or live; give one of them";
            return Err(usage("planes", message.into()));
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
        pass.check_samples()?;
        match &pass.begun {
            PassKind::RenderPass { pass: raw, .. } => pass.check_render_pass(device, *raw),
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

impl PassFormats {
    fn check_samples(&self) -> Result<()> {
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
        let wanted = color_formats(self.planes).len();
        if color.len() != wanted {
            let (planes, count) = (self.planes, color.len());
            let message = format!("{count} attachments for the planes {planes:?}; give {wanted}");
            return Err(usage("color", message));
        }
        use vk::ImageUsageFlags as U;
        for &format in color {
            if format == vk::Format::UNDEFINED || has_depth(format) || has_stencil(format) {
                let message = format!("{format:?} holds no colours; give a format that does");
                return Err(usage("color", message));
            }
            if is_integer(format) {
                let message = format!("{format:?} holds integers; give fractions or floats");
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

/// Reads the name of the format in the specification, whose last part is the numeric type.
fn is_integer(format: vk::Format) -> bool {
    let name = format!("{format:?}");
    name.contains("_UINT") || name.contains("_SINT")
}
