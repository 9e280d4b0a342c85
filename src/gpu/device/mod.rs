//! The state of a device that everything made on it shares, and what opening a device needs.

pub(crate) mod budget;
pub(crate) mod instance;
pub(crate) mod limits;
mod loader_variables;
pub(crate) mod report;

use crate::error::Result;
use crate::gpu::vk::call::Call;
use crate::gpu::vk::pipelines::Pipelines;
use ash::ext::debug_utils;
use ash::vk;
use budget::MemoryBudget;
use gpu_allocator::vulkan::Allocator;
use instance::Instance;
use report::Candidate;
use std::ffi::{CStr, CString};
use std::mem::ManuallyDrop;
use std::sync::{Arc, Mutex, OnceLock};

/// The state of a device, which everything made on it keeps alive. Members are destroyed in order.
pub(crate) struct Shared {
    // Dropped before the device: see Drop.
    pub allocator: ManuallyDrop<Arc<Mutex<Allocator>>>,
    pub pipelines: ManuallyDrop<Pipelines>,
    pub raw: ash::Device,
    pub queue: Option<Arc<Mutex<vk::Queue>>>,
    pub functions: ash::Instance,
    /// The physical device, with the features that are on.
    pub chosen: Candidate,
    pub budget: Mutex<MemoryBudget>,
    /// The functions that label commands and name handles (`VK_EXT_debug_utils`); empty if the host
    /// has not enabled them.
    pub debug_labels: OnceLock<debug_utils::Device>,
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
    let mut info = vk::DeviceCreateInfo::default()
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
            allocator: ManuallyDrop::new(memory),
            pipelines: ManuallyDrop::new(pipelines),
            queue: queue.map(|queue| Arc::new(Mutex::new(queue))),
            functions: instance.clone(),
            budget: Mutex::default(),
            debug_labels: OnceLock::new(),
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

    pub fn name(&self, handle: impl vk::Handle, name: &str) {
        if let (Some(functions), Ok(name)) = (self.debug_labels.get(), CString::new(name)) {
            let info = vk::DebugUtilsObjectNameInfoEXT::default()
                .object_handle(handle)
                .object_name(&name);
            // A name is no reason to fail.
            // SAFETY: the handle is live, and of the device of the functions.
            let _ = unsafe { functions.set_debug_utils_object_name(&info) };
        }
    }

    pub fn labelled<T>(
        &self,
        cmd: vk::CommandBuffer,
        label: &CStr,
        commands: impl FnOnce() -> T,
    ) -> T {
        let functions = self.debug_labels.get();
        if let Some(functions) = functions {
            let info = vk::DebugUtilsLabelEXT::default().label_name(label);
            // SAFETY: `cmd` is recording, as the callers' callers promised.
            unsafe { functions.cmd_begin_debug_utils_label(cmd, &info) };
        }
        let result = commands();
        if let Some(functions) = functions {
            // SAFETY: as above; the label was begun.
            unsafe { functions.cmd_end_debug_utils_label(cmd) };
        }
        result
    }
}

impl Drop for Shared {
    fn drop(&mut self) {
        let owned = self.instance.is_some();
        // SAFETY: everything made on the device kept this alive and is gone by now; a host has
        // waited for its own work. What is dropped here is not used again.
        unsafe {
            if owned {
                let _ = self.raw.device_wait_idle();
            }
            ManuallyDrop::drop(&mut self.pipelines);
            ManuallyDrop::drop(&mut self.allocator);
            if owned {
                self.raw.destroy_device(None);
            }
        }
    }
}

/// Bits of the memory types that are host-visible and coherent, but not device-local.
fn host_types(instance: &ash::Instance, physical: vk::PhysicalDevice) -> u32 {
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
