//! The state of a device that everything made on it shares, and what opening a device needs.

pub(crate) mod budget;
pub(crate) mod instance;
pub(crate) mod report;

use crate::error::{Error, ErrorKind, Result};
use crate::gpu::vk::call::Call;
use crate::gpu::vk::debug::DebugLabels;
use crate::gpu::vk::pipelines::Pipelines;
use ash::vk;
use budget::MemoryBudget;
use gpu_allocator::vulkan::Allocator;
use instance::Instance;
use report::Candidate;
use std::ffi::CStr;
use std::sync::{Arc, Mutex, MutexGuard};

/// The state of a device, which everything made on it keeps alive.
pub(crate) struct Shared {
    // Dropped before the device: see Drop.
    pub allocator: Option<Arc<Mutex<Allocator>>>,
    pub pipelines: Option<Pipelines>,
    pub raw: ash::Device,
    pub queue: Option<Arc<Mutex<vk::Queue>>>,
    /// The functions of the instance.
    pub functions: ash::Instance,
    /// The physical device, with the features that are on.
    pub chosen: Candidate,
    pub budget: MemoryBudget,
    pub debug_labels: DebugLabels,
    /// Bits of the memory types that are host-visible and coherent, but not device-local.
    pub host_types: u32,
    /// `None` for a borrowed device.
    pub instance: Option<Instance>,
    /// The device that [`Device::with_shaders`](crate::gpu::Device::with_shaders) was called on; it must outlive this one.
    #[cfg(feature = "other-shaders")]
    #[allow(dead_code)]
    pub opened: Option<Arc<Shared>>,
}

/// Makes a device with the optional features that it offers, and with these extensions.
pub(in crate::gpu) fn create(
    instance: &Instance,
    chosen: &Candidate,
    extensions: &[&CStr],
    more: Option<&mut dyn vk::ExtendsDeviceCreateInfo>,
) -> Result<ash::Device> {
    let priorities = [1.0];
    let queues = [vk::DeviceQueueCreateInfo::default()
        .queue_family_index(chosen.family)
        .queue_priorities(&priorities)];
    let features = chosen.wanted_features();
    let mut extensions: Vec<_> = extensions.iter().map(|name| name.as_ptr()).collect();
    if chosen.offers(ash::khr::portability_subset::NAME) {
        extensions.push(ash::khr::portability_subset::NAME.as_ptr());
    }
    // Every device of Vulkan 1.1 offers it.
    let mut views = vk::PhysicalDeviceMultiviewFeatures::default().multiview(true);
    let mut info = vk::DeviceCreateInfo::default()
        .push_next(&mut views)
        .queue_create_infos(&queues)
        .enabled_extension_names(&extensions)
        .enabled_features(&features);
    if let Some(more) = more {
        info = info.push_next(more);
    }
    // SAFETY: `info` requests only what the physical device offers.
    unsafe { instance.raw.create_device(chosen.physical, &info, None) }.call("vkCreateDevice")
}

impl Shared {
    pub fn new(
        instance: &ash::Instance,
        chosen: Candidate,
        raw: ash::Device,
        queue: Option<vk::Queue>,
        memory: Arc<Mutex<Allocator>>,
        pipeline_cache: Option<vk::PipelineCache>,
    ) -> Result<Self> {
        let pipelines = Pipelines::new(raw.clone(), pipeline_cache, chosen.constants())?;
        Ok(Self {
            allocator: Some(memory),
            pipelines: Some(pipelines),
            queue: queue.map(|queue| Arc::new(Mutex::new(queue))),
            functions: instance.clone(),
            budget: MemoryBudget::default(),
            debug_labels: DebugLabels::default(),
            host_types: host_types(instance, chosen.physical),
            chosen,
            raw,
            instance: None,
            #[cfg(feature = "other-shaders")]
            opened: None,
        })
    }

    pub fn limits(&self) -> &vk::PhysicalDeviceLimits {
        &self.chosen.properties.limits
    }

    pub fn allocator(&self) -> Result<MutexGuard<'_, Allocator>> {
        self.allocator
            .as_ref()
            .and_then(|a| a.lock().ok())
            .ok_or_else(|| {
                Error::new(
                    ErrorKind::Other,
                    "the device's allocator is gone after a panic",
                )
            })
    }

    pub fn pipelines(&self) -> Result<&Pipelines> {
        self.pipelines
            .as_ref()
            .ok_or_else(|| Error::new(ErrorKind::Other, "the device is being closed"))
    }
}

impl Drop for Shared {
    fn drop(&mut self) {
        // SAFETY: everything made on the device kept this alive and is gone by now; a host has
        // waited for its own work.
        unsafe {
            if self.instance.is_some() {
                let _ = self.raw.device_wait_idle();
            }
            self.pipelines = None;
            self.allocator = None;
            if self.instance.is_some() {
                self.raw.destroy_device(None);
            }
        }
    }
}

/// Bits of the memory types that are host-visible and coherent, but not device-local.
pub(crate) fn host_types(instance: &ash::Instance, physical: vk::PhysicalDevice) -> u32 {
    use vk::MemoryPropertyFlags as Flags;
    // SAFETY: plain query of a live physical device.
    let all = unsafe { instance.get_physical_device_memory_properties(physical) };
    let seen = Flags::HOST_VISIBLE | Flags::HOST_COHERENT;
    let of_host = |flags: Flags| flags & (seen | Flags::DEVICE_LOCAL) == seen;
    (0u32..)
        .zip(all.memory_types_as_slice())
        .filter(|(_, kind)| of_host(kind.property_flags))
        .fold(0, |bits, (number, _)| bits | 1 << number)
}
