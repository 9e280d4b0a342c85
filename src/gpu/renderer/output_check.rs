//! Checks of an output: what the device draws into, and the memory that compute writes to.

use crate::error::{Error, ErrorKind, Result, content, usage};
use crate::gpu::device::Shared;
use crate::gpu::device::limits::fragment_resources;
use crate::gpu::vk::call::kind_of;
use crate::gpu::vk::output::{ComputeTarget, Output, PassFormats, PassKind};
use crate::maps::MapFormat;
use crate::plan::{MOST_PIXELS, View};
use crate::settings::{Plane, Planes, SearchSettings};
use ash::vk;

impl Output {
    /// Returns an error for an output that the device or the solver cannot draw.
    pub(crate) fn check(&self, device: &Shared, settings: &SearchSettings) -> Result<()> {
        let (planes, solver) = (self.planes(), settings.solver);
        let exact = solver.external().is_none();
        let all_outputs = matches!(planes, Planes::Color | Planes::All);
        if !(all_outputs || exact && matches!(self, Self::Pass(_))) {
            let message = "depth alone and lists are drawn in a pass, by exact, quadric or live; give one of them";
            return usage("planes", message);
        }
        if matches!(planes, Planes::List(_)) && settings.map_format == MapFormat::Rgba8 {
            let message = "lists of planes read no map in rgba8; take r16 or r32";
            return usage("map_format", message);
        }
        match self {
            Self::Pass(pass) => pass.check(device),
            Self::Compute(_) => Ok(()),
        }
    }

    /// Returns an error for a missing target, a target that does not fit, or an unneeded target.
    pub(crate) fn check_target(&self, target: Option<&ComputeTarget>) -> Result<()> {
        let compute = matches!(self, Self::Compute(_));
        let all = self.planes() == Planes::All;
        let target = match target {
            None if !compute && !all => return Ok(()),
            None => {
                let message = "shaders write to a target; give one to set_compute_target";
                return usage("target", message);
            }
            Some(target) => target,
        };
        if !compute && !all {
            return usage(
                "target",
                "only attachments are drawn into; leave the target out",
            );
        }
        if target.words == vk::Buffer::null() {
            return usage("words", "the buffer is null; give one");
        }
        let (count, wanted) = (target.images.len(), if compute && all { 4 } else { 0 });
        if count != wanted || target.images.contains(&vk::ImageView::null()) {
            let message = format!("{count} images; give {wanted}, none of them null");
            return usage("images", message);
        }
        Ok(())
    }
}

/// Returns an error for a viewport that the device does not take, and for one whose part in the
/// largest framebuffer has pixels beyond those that records of tiles hold.
pub(super) fn check_viewport(view: &View, limits: &vk::PhysicalDeviceLimits) -> Result<()> {
    let (v, [low, high]) = (&view.viewport, view.corners());
    let [least, most] = limits.viewport_bounds_range.map(f64::from);
    let [wide, tall] = limits.max_viewport_dimensions.map(f64::from);
    let inside = |end: f64| (least..=most).contains(&end);
    let fits = [low.x, low.y, high.x, high.y].into_iter().all(inside);
    if !fits || v.width > wide || v.height.abs() > tall {
        let message = format!(
            "{} x {} pixels at {}, {} are more than the device has; give up to {wide} x {tall} within {least} to {most}",
            v.width, v.height, v.x, v.y
        );
        return content("view.viewport", message);
    }
    let largest = [limits.max_framebuffer_width, limits.max_framebuffer_height];
    let ends = [high.x, high.y].into_iter().zip(largest.map(f64::from));
    if ends.map(|(end, side)| end.min(side)).fold(0.0, f64::max) > f64::from(MOST_PIXELS) {
        let message = format!("ends beyond pixel {MOST_PIXELS}; draw a smaller picture");
        return content("view.viewport", message);
    }
    Ok(())
}

impl PassFormats {
    fn check(&self, device: &Shared) -> Result<()> {
        let (features, limits) = (&device.chosen.features, device.limits());
        let samples = self.samples;
        let all = self.planes == Planes::All;
        let unsupported = |message: &str| Err(Error::new(ErrorKind::Unsupported, message));
        if all && features.fragment_stores_and_atomics == vk::FALSE {
            let message =
                "all planes in a pass need the feature fragmentStoresAndAtomics; enable it";
            return unsupported(message);
        }
        if self.sample_rays && features.sample_rate_shading == vk::FALSE {
            let message = "rays through samples need the feature sampleRateShading; enable it";
            return unsupported(message);
        }
        if !self.slope_bias.is_none() && !matches!(self.planes, Planes::Depth { .. }) {
            let message = "only depths alone have a bias for slopes; draw Planes::Depth";
            return usage("slope_bias", message);
        }
        if ![1, 2, 4, 8].contains(&samples) {
            return usage("samples", format!("{samples} samples; give 1, 2, 4 or 8"));
        }
        let (planes, most) = (self.planes.attachments(), limits.max_color_attachments);
        if planes > most as usize {
            let message = format!("{planes} planes; the device draws into {most} at once");
            return Err(Error::new(ErrorKind::Unsupported, message).at_key("planes"));
        }
        let (drawn, most) = (planes as u32, limits.max_fragment_combined_output_resources);
        if fragment_resources() + drawn > most {
            let needed = fragment_resources() + drawn;
            let message = format!(
                "{planes} planes; the device lacks maxFragmentCombinedOutputResources of {needed} (it has {most})"
            );
            return Err(Error::new(ErrorKind::Unsupported, message).at_key("planes"));
        }
        match &self.begun {
            PassKind::RenderPass { pass, .. } if pass.raw() == vk::RenderPass::null() => {
                usage("pass", "the render pass is null; give one")
            }
            // Vulkan cannot return the formats of a render pass.
            PassKind::RenderPass { .. } => {
                let colors = limits.framebuffer_color_sample_counts;
                self.check_counts(device, colors & limits.framebuffer_depth_sample_counts)
            }
            PassKind::SingleSubpass { color, depth } => {
                self.check_formats(device, color, *depth, vk::Format::UNDEFINED)
            }
            PassKind::Dynamic {
                color,
                depth,
                stencil,
            } => self.check_formats(device, color, *depth, *stencil),
        }
    }

    fn check_formats(
        &self,
        device: &Shared,
        color: &[vk::Format],
        depth: vk::Format,
        stencil: vk::Format,
    ) -> Result<()> {
        use vk::ImageAspectFlags as A;
        use vk::ImageUsageFlags as U;
        let (planes, count, wanted) = (self.planes, color.len(), self.planes.attachments());
        if count != wanted {
            let message = format!("{count} attachments for the planes {planes:?}; give {wanted}");
            return usage("color", message);
        }
        for (&format, number) in color.iter().zip(0..) {
            let plane = match planes {
                Planes::List(list) => list.planes()[number],
                _ => Plane::Color,
            };
            if aspects(format) != A::COLOR {
                let message = format!("{format:?} holds no colours; give a format that does");
                return usage("color", message);
            }
            if let Some(wanted) = misfit(plane, format) {
                let message = format!("{format:?} does not hold {plane:?}; give {wanted}");
                return usage("color", message);
            }
            self.check_format(device, format, U::COLOR_ATTACHMENT)?;
        }
        if !aspects(depth).contains(A::DEPTH) {
            let message = format!("{depth:?} holds no depths; give a format that does");
            return usage("depth", message);
        }
        self.check_format(device, depth, U::DEPTH_STENCIL_ATTACHMENT)?;
        let fits = aspects(stencil).contains(A::STENCIL) && stencil == depth;
        if !fits && stencil != vk::Format::UNDEFINED {
            let message =
                format!("{stencil:?} is not the depth's format, with stencil; give that, or none");
            return usage("stencil", message);
        }
        Ok(())
    }

    fn check_format(
        &self,
        device: &Shared,
        format: vk::Format,
        usage: vk::ImageUsageFlags,
    ) -> Result<()> {
        let (tiling, flags) = (vk::ImageTiling::OPTIMAL, vk::ImageCreateFlags::empty());
        let (kind, physical) = (vk::ImageType::TYPE_2D, device.chosen.physical);
        let functions = &device.functions;
        // SAFETY: plain query of the device's own physical device.
        let found = unsafe {
            functions.get_physical_device_image_format_properties(
                physical, format, kind, tiling, usage, flags,
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

/// What an image of a format holds.
fn aspects(format: vk::Format) -> vk::ImageAspectFlags {
    use vk::Format as F;
    use vk::ImageAspectFlags as A;
    match format {
        F::UNDEFINED => A::empty(),
        F::S8_UINT => A::STENCIL,
        F::D16_UNORM | F::X8_D24_UNORM_PACK32 | F::D32_SFLOAT => A::DEPTH,
        F::D16_UNORM_S8_UINT | F::D24_UNORM_S8_UINT | F::D32_SFLOAT_S8_UINT => {
            A::DEPTH | A::STENCIL
        }
        _ => A::COLOR,
    }
}

/// The kind of format that a plane needs, unless `format` is one. Reads the name of the format in
/// the specification, whose last part is the numeric type.
fn misfit(plane: Plane, format: vk::Format) -> Option<&'static str> {
    let name = format!("{format:?}");
    let is = |part: &str| name.contains(part);
    let signed = is("_SNORM") || is("_SFLOAT");
    let fraction = !is("_UINT") && !is("_SINT");
    let words = ["R32G32_UINT", "R32G32B32A32_UINT"];
    let (fits, wanted) = match plane {
        Plane::Identity => (
            words.iter().any(|one| is(one)),
            "R32G32_UINT or R32G32B32A32_UINT",
        ),
        Plane::Normal => (signed && is("B"), "three signed channels or floats"),
        Plane::OctahedralNormal => (signed && is("G"), "two signed channels or floats"),
        Plane::Motion => (is("_SFLOAT") && is("G"), "two floats"),
        Plane::Material => (fraction && is("G"), "two fractions or floats"),
        Plane::Color | Plane::BaseColor => (fraction, "fractions or floats"),
    };
    (!fits).then_some(wanted)
}
