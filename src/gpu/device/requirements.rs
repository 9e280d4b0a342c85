//! The requirements on a device, for hosts that open it themselves.

use crate::error::Result;
use crate::gpu::device::instance::API_VERSION;
use crate::gpu::device::report::{inspect, refuse};
use ash::vk;

/// The settings with which a host opens a device that a renderer borrows.
#[derive(Clone, Debug)]
pub struct Requirements {
    /// Lowest Vulkan version, of the instance and of the device.
    pub api_version: u32,
    /// Features to enable. [`Planes::Color`](crate::settings::Planes::Color) in a pass needs none
    /// of them. The host may enable more.
    pub features: vk::PhysicalDeviceFeatures,
    /// The first queue family on which everything works: graphics and compute.
    pub queue_family: u32,
    /// Names of device extensions; none in this version. A host that uses dynamic rendering enables
    /// it itself.
    pub extensions: Vec<&'static std::ffi::CStr>,
}

impl Requirements {
    /// The requirements on one physical device.
    ///
    /// # Errors
    /// [`Unsupported`](crate::error::ErrorKind::Unsupported) if the device lacks a requirement; the
    /// message lists all that it lacks.
    ///
    /// # Safety
    /// The call only makes queries of `physical`. The caller must ensure that `physical` belongs to
    /// `instance`, and that the instance lives until the call returns.
    pub unsafe fn of(instance: &ash::Instance, physical: vk::PhysicalDevice) -> Result<Self> {
        let candidate = inspect(instance, 0, physical);
        refuse(&candidate)?;
        Ok(Self {
            api_version: API_VERSION,
            features: candidate.wanted_features(),
            queue_family: candidate.family,
            extensions: Vec::new(),
        })
    }
}
