//! The capabilities of each Vulkan device, and the choice of one.

use crate::error::{Error, ErrorKind, Result};
use crate::frame::MAX_PIXELS;
use crate::gpu::device::instance::{API_VERSION, Instance, is_among, no_driver, packages};
use crate::gpu::device::limits::lacking;
use crate::gpu::device::loader_variables::hidden_drivers;
use crate::gpu::vk::pipelines::DeviceConstants;
use crate::shader::generated::{GROUP_PIXELS, MOST_OWN_VECTORS, PATCH_VECTORS};
use ash::vk;
use std::env::consts::OS;
use std::ffi::{CStr, FromBytesUntilNulError};

/// The environment variable that names the device to open.
pub const DEVICE_VARIABLE: &str = "REVMAP_DEVICE";

/// The description and the capabilities of a Vulkan device.
#[derive(Clone, Debug)]
pub struct DeviceReport {
    /// Position in the loader's list; [`Device::open`](crate::gpu::Device::open) takes it.
    pub index: usize,
    /// The device's name.
    pub name: String,
    /// `discrete`, `integrated`, `virtual`, `cpu` or `other`.
    pub kind: &'static str,
    /// Driver's name and version.
    pub driver: String,
    /// Vulkan version, such as `1.3.230`.
    pub api_version: String,
    /// Features and limits that a renderer would use: `(name, value)`.
    pub uses: Vec<(String, String)>,
    /// Requirements that the device lacks. Renderers can be made on it if this is empty.
    pub missing: Vec<String>,
    /// True if [`Device::open`](crate::gpu::Device::open) opens this device when none is named.
    pub preferred: bool,
}

/// A device with the values that opening it needs.
#[derive(Clone)]
pub(crate) struct Candidate {
    pub report: DeviceReport,
    pub physical: vk::PhysicalDevice,
    pub family: u32,
    pub timestamp_bits: u32,
    pub features: vk::PhysicalDeviceFeatures,
    pub properties: vk::PhysicalDeviceProperties,
    pub subgroup_size: u32,
    pub extensions: Vec<vk::ExtensionProperties>,
}

impl Candidate {
    /// The largest anisotropy of textures; none if they are not filtered so. Software devices take
    /// ten times as long for it, and llvmpipe filters differently in fragment and compute shaders.
    pub fn anisotropy(&self) -> Option<f32> {
        let filters = self.features.sampler_anisotropy == vk::TRUE
            && self.properties.device_type != vk::PhysicalDeviceType::CPU;
        filters.then_some(self.properties.limits.max_sampler_anisotropy)
    }

    /// Returns true if squares of up to eight pixels a side are drawn as points. A point takes one
    /// vertex in place of six. A point has no diagonal, along which blocks of pixels are searched
    /// twice.
    pub fn large_points(&self) -> bool {
        let limits = &self.properties.limits;
        let [least, most] = limits.point_size_range;
        let step = limits.point_size_granularity;
        self.features.large_points == vk::TRUE
            && least <= 1.0
            && most >= GROUP_PIXELS as f32
            && (step == 0.0 || (1.0 / step).fract() == 0.0)
    }

    /// The largest number of indexed draws in one indirect command; 0 without the needed features.
    pub fn most_draws(&self) -> u32 {
        let features = &self.features;
        match [
            features.multi_draw_indirect,
            features.draw_indirect_first_instance,
        ] {
            [vk::TRUE, vk::TRUE] => self.properties.limits.max_draw_indirect_count,
            _ => 0,
        }
    }

    pub fn offers(&self, extension: &CStr) -> bool {
        is_among(&self.extensions, extension)
    }

    pub fn constants(&self) -> DeviceConstants {
        let limits = &self.properties.limits;
        let most = limits.max_uniform_buffer_range / 16;
        let is_software = self.properties.device_type == vk::PhysicalDeviceType::CPU;
        DeviceConstants {
            own_vectors: most.clamp(PATCH_VECTORS, MOST_OWN_VECTORS),
            large_points: self.large_points(),
            fetched_cells: !is_software,
            // SwiftShader's views hold 65,536 vectors.
            texels: is_software
                && limits.max_texel_buffer_elements >= limits.max_storage_buffer_range / 16,
            indexes_textures: self.features.shader_sampled_image_array_dynamic_indexing == vk::TRUE,
        }
    }

    /// The optional features that are enabled if the device offers them.
    pub fn wanted_features(&self) -> vk::PhysicalDeviceFeatures {
        vk::PhysicalDeviceFeatures {
            fragment_stores_and_atomics: vk::TRUE,
            sampler_anisotropy: vk::Bool32::from(self.anisotropy().is_some()),
            large_points: vk::Bool32::from(self.large_points()),
            sample_rate_shading: self.features.sample_rate_shading,
            shader_sampled_image_array_dynamic_indexing: self
                .features
                .shader_sampled_image_array_dynamic_indexing,
            multi_draw_indirect: self.features.multi_draw_indirect,
            draw_indirect_first_instance: self.features.draw_indirect_first_instance,
            ..Default::default()
        }
    }

    fn uses(&self) -> Vec<(String, String)> {
        let flag = |what, is| (what, if is { "yes" } else { "no" }.to_owned());
        let limits = &self.properties.limits;
        let timestamps = match self.timestamp_bits {
            0 => "no: times are the wall clock's alone".to_owned(),
            bits => format!("{bits} bits of {} ns", limits.timestamp_period),
        };
        let (width, height) = (limits.max_framebuffer_width, limits.max_framebuffer_height);
        let side = limits.max_image_dimension2_d;
        [
            ("GPU timestamps", timestamps),
            flag("anisotropic filtering", self.anisotropy().is_some()),
            flag("tiles of walks as points", self.large_points()),
            ("largest map", format!("{side} texels a side")),
            (
                "largest picture",
                format!("{width} x {height}, and {MAX_PIXELS} pixels in all"),
            ),
        ]
        .map(|(what, which)| (what.to_owned(), which))
        .to_vec()
    }
}

/// All devices that the Vulkan loader offers.
///
/// # Errors
/// [`ErrorKind::Unsupported`] if there is no loader or no device.
pub fn devices() -> Result<Vec<DeviceReport>> {
    let instance = Instance::from_environment()?;
    let found = candidates(&instance)?;
    if found.is_empty() {
        return Err(none());
    }
    let preferred = position(&found, variable().as_deref()).ok();
    let mut reports: Vec<_> = found.into_iter().map(|c| c.report).collect();
    if let Some(report) = preferred.and_then(|p| reports.get_mut(p)) {
        report.preferred = true;
    }
    Ok(reports)
}

/// The device that the environment names.
fn variable() -> Option<String> {
    let set = std::env::var_os(DEVICE_VARIABLE);
    let set = set.map(|device| device.to_string_lossy().into_owned());
    set.filter(|device| !device.is_empty())
}

fn none() -> Error {
    let remedy = hidden_drivers().unwrap_or_else(|| packages(OS).driver.to_owned());
    let message = format!("the Vulkan loader found no device; {remedy}");
    Error::new(ErrorKind::Unsupported, message)
}

fn candidates(instance: &Instance) -> Result<Vec<Candidate>> {
    // SAFETY: plain query of a live instance.
    let all = unsafe { instance.raw.enumerate_physical_devices() }
        .map_err(|code| no_driver("vkEnumeratePhysicalDevices", code))?;
    let inspected = |(index, physical)| inspect(&instance.raw, index, physical);
    Ok(all.into_iter().enumerate().map(inspected).collect())
}

/// The device that `choice` names, else the environment: an index, or part of a name, in any case.
/// The default is the first by kind.
pub(crate) fn choose(instance: &Instance, choice: Option<&str>) -> Result<Candidate> {
    let (mut all, variable) = (candidates(instance)?, variable());
    let position = position(&all, choice.or(variable.as_deref())).map_err(|mut e| {
        if choice.is_none() && e.kind == ErrorKind::Usage {
            e.key = Some(DEVICE_VARIABLE.to_owned());
        }
        e
    });
    let chosen = all.swap_remove(position?);
    refuse(&chosen)?;
    Ok(chosen)
}

fn position(all: &[Candidate], choice: Option<&str>) -> Result<usize> {
    let Some(wanted) = choice else {
        let usable = (0..all.len()).filter(|&k| all[k].report.missing.is_empty());
        let first = usable.min_by_key(|&k| rank(all[k].properties.device_type));
        return first.or((!all.is_empty()).then_some(0)).ok_or_else(none);
    };
    let names: Vec<&str> = all.iter().map(|c| c.report.name.as_str()).collect();
    find(&names, wanted).map_err(|what| {
        let numbered = names.iter().enumerate();
        let listed = numbered.map(|(index, name)| format!("{index} {name}"));
        let listed = listed.collect::<Vec<_>>().join(", ");
        let message = format!("{what}; there are: {listed}");
        Error::new(ErrorKind::Usage, message).at_key("device")
    })
}

/// The first of `names` that `wanted` names: a number is an index, all else is part of a name, in
/// any case. The error says what is not there.
fn find(names: &[&str], wanted: &str) -> std::result::Result<usize, String> {
    if let Ok(index) = wanted.parse::<usize>() {
        let found = (index < names.len()).then_some(index);
        return found.ok_or_else(|| format!("there is no device {index}"));
    }
    let part = wanted.to_lowercase();
    let found = names
        .iter()
        .position(|name| names_part(&name.to_lowercase(), &part));
    found.ok_or_else(|| format!("no device is called '{wanted}'"))
}

/// Returns true if `part` is in `name` and no number of the name is cut: `rtx 40` is no part of
/// `rtx 4090`.
fn names_part(name: &str, part: &str) -> bool {
    let number = |c: Option<char>| c.is_some_and(|c| c.is_ascii_digit() || c == '.');
    let whole = |(at, found): (usize, &str)| {
        let (before, after) = (&name[..at], &name[at + found.len()..]);
        let starts = number(part.chars().next()) && number(before.chars().next_back());
        let ends = number(part.chars().next_back()) && number(after.chars().next());
        !starts && !ends
    };
    !part.is_empty() && name.match_indices(part).any(whole)
}

/// Returns an error for a device that lacks a requirement.
pub(crate) fn refuse(candidate: &Candidate) -> Result<()> {
    let report = &candidate.report;
    if report.missing.is_empty() {
        return Ok(());
    }
    let missing = report.missing.join(", ");
    let message = format!("{} lacks {missing}; choose another", report.name);
    Err(Error::new(ErrorKind::Unsupported, message).at_key("device"))
}

/// Kinds of devices, the preferred first.
const KINDS: [(vk::PhysicalDeviceType, &str); 4] = [
    (vk::PhysicalDeviceType::DISCRETE_GPU, "discrete"),
    (vk::PhysicalDeviceType::INTEGRATED_GPU, "integrated"),
    (vk::PhysicalDeviceType::VIRTUAL_GPU, "virtual"),
    (vk::PhysicalDeviceType::CPU, "cpu"),
];

/// The number of a kind in [`KINDS`], or one more.
fn rank(kind: vk::PhysicalDeviceType) -> usize {
    let found = KINDS.iter().position(|(known, _)| *known == kind);
    found.unwrap_or(KINDS.len())
}

fn version(v: u32) -> String {
    use vk::{api_version_major as major, api_version_minor as minor, api_version_patch as patch};
    format!("{}.{}.{}", major(v), minor(v), patch(v))
}

pub(crate) fn text(raw: std::result::Result<&CStr, FromBytesUntilNulError>) -> String {
    raw.unwrap_or_default().to_string_lossy().into_owned()
}

pub(crate) fn inspect(
    raw: &ash::Instance,
    index: usize,
    physical: vk::PhysicalDevice,
) -> Candidate {
    let mut driver = vk::PhysicalDeviceDriverProperties::default();
    let mut extended = vk::PhysicalDeviceProperties2::default();
    // SAFETY: plain queries of a live physical device.
    let (basic, features, families, extensions) = unsafe {
        (
            raw.get_physical_device_properties(physical),
            raw.get_physical_device_features(physical),
            raw.get_physical_device_queue_family_properties(physical),
            raw.enumerate_device_extension_properties(physical)
                .unwrap_or_default(),
        )
    };
    let mut subgroup = vk::PhysicalDeviceSubgroupProperties::default();
    let mut missing = Vec::new();
    if basic.api_version >= API_VERSION {
        extended = extended.push_next(&mut driver).push_next(&mut subgroup);
        // SAFETY: the device has version 1.2 or later, whose core has the query.
        unsafe { raw.get_physical_device_properties2(physical, &mut extended) };
    } else {
        missing.push(format!("Vulkan {}", version(API_VERSION)));
    }
    let both = vk::QueueFlags::GRAPHICS | vk::QueueFlags::COMPUTE;
    let family = families.iter().position(|f| f.queue_flags.contains(both));
    if family.is_none() {
        missing.push("a queue for graphics and compute".to_owned());
    }
    if features.fragment_stores_and_atomics == vk::FALSE {
        missing.push("fragmentStoresAndAtomics".to_owned());
    }
    missing.extend(lacking(&basic.limits));
    for (format, wanted, what) in formats() {
        // SAFETY: plain query.
        let offered = unsafe { raw.get_physical_device_format_properties(physical, format) };
        if !offered.optimal_tiling_features.contains(wanted) {
            missing.push(what.to_owned());
        }
    }
    let timestamp_bits = family.map_or(0, |f| families[f].timestamp_valid_bits);
    let driver = [driver.driver_name_as_c_str(), driver.driver_info_as_c_str()].map(text);
    let mut candidate = Candidate {
        report: DeviceReport {
            index,
            name: text(basic.device_name_as_c_str()),
            kind: KINDS
                .get(rank(basic.device_type))
                .map_or("other", |kind| kind.1),
            driver: driver.join(" ").trim().to_owned(),
            api_version: version(basic.api_version),
            uses: Vec::new(),
            missing,
            preferred: false,
        },
        physical,
        family: family.and_then(|f| u32::try_from(f).ok()).unwrap_or(0),
        timestamp_bits,
        features,
        properties: basic,
        subgroup_size: subgroup.subgroup_size,
        extensions,
    };
    candidate.report.uses = candidate.uses();
    candidate
}

/// Formats with the uses that a renderer needs of them.
fn formats() -> [(vk::Format, vk::FormatFeatureFlags, &'static str); 4] {
    use vk::{Format as F, FormatFeatureFlags as Use};
    let sampled = Use::SAMPLED_IMAGE;
    let drawn = Use::COLOR_ATTACHMENT | Use::STORAGE_IMAGE;
    let tested = Use::DEPTH_STENCIL_ATTACHMENT;
    let targets = "render targets and storage images of 32-bit floats";
    [
        (F::R16_SFLOAT, sampled, "sampled 16-bit float images"),
        (F::R32_SFLOAT, sampled, "sampled 32-bit float images"),
        (F::R32G32B32A32_SFLOAT, drawn, targets),
        (F::D32_SFLOAT, tested, "a 32-bit float depth buffer"),
    ]
}

#[cfg(test)]
mod tests {
    use super::find;

    #[test]
    fn numbers_are_indices_and_names_are_not_cut() {
        let names = [
            "llvmpipe (LLVM 15.0.6, 256 bits)",
            "NVIDIA GeForce RTX 4090",
            "RTX 40",
        ];
        let found = [
            (0, "0,LLVM,pipe,15.0.6"),
            (1, "1,nvidia,rtx 4090,RTX"),
            (2, "rtx 40"),
        ];
        for (index, all) in found {
            for wanted in all.split(',') {
                assert_eq!(find(&names, wanted), Ok(index), "{wanted}");
            }
        }
        for wanted in "3,5,256,4090,4294967296,5.0,15.0,0.6,40 9,,amd".split(',') {
            assert!(find(&names, wanted).is_err(), "{wanted}");
        }
        assert_eq!(find(&names, "5"), Err("there is no device 5".to_owned()));
    }
}
