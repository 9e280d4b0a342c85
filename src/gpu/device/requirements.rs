//! What a device must offer, for hosts that open it themselves.

use crate::error::Result;
use crate::gpu::device::instance::API_VERSION;
use crate::gpu::device::report::{inspect, refuse};
use ash::vk;

/// What a host has to enable when it opens a device that a renderer shall borrow.
#[derive(Clone, Debug)]
pub struct Requirements {
    /// Least Vulkan version, of the instance and of the device.
    pub api_version: u32,
    /// Features to enable. None of them is needed for
    /// [`Planes::Color`](crate::settings::Planes::Color) in a pass; more may be enabled.
    pub features: vk::PhysicalDeviceFeatures,
    /// The first queue family on which everything works: graphics and compute.
    pub queue_family: u32,
    /// Names of device extensions; none today. Dynamic rendering is the host's to enable, where it
    /// uses it.
    pub extensions: Vec<&'static std::ffi::CStr>,
}

impl Requirements {
    /// Of one physical device.
    ///
    /// # Errors
    /// [`Unsupported`](crate::error::ErrorKind::Unsupported) when it lacks something, with all that
    /// it lacks.
    ///
    /// # Safety
    /// This call makes queries of `physical` alone. The caller must see to it that `physical`
    /// belongs to `instance`, and that the instance lives until the call returns.
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
