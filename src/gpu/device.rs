//! An open device: one queue for graphics and compute, and an allocator.

use super::call::Call;
use super::instance::Instance;
use super::report::{Candidate, DEVICE_VARIABLE, DeviceReport, candidates, choose};
use crate::error::{Error, Result, Stage};
use ash::vk;
use gpu_allocator::vulkan::{Allocator, AllocatorCreateDesc};
use gpu_allocator::{AllocationSizes, AllocatorDebugSettings};
use std::sync::{Arc, Mutex, MutexGuard};

/// An open Vulkan device. Clones share it; it closes when the last user is gone.
#[derive(Clone)]
pub struct Device {
    pub(crate) shared: Arc<Shared>,
}

/// What everything made on a device keeps alive.
pub(crate) struct Shared {
    // Dropped before the device: see Drop.
    allocator: Option<Mutex<Allocator>>,
    pub raw: ash::Device,
    pub queue: Mutex<vk::Queue>,
    pub family: u32,
    pub limits: vk::PhysicalDeviceLimits,
    pub timestamp_bits: u32,
    pub anisotropy: Option<f32>,
    pub report: DeviceReport,
    instance: Instance,
}

impl Device {
    /// Opens the device chosen by `choice` (index, or part of a name), else by the environment variable `REVMAP_DEVICE`, else
    /// the first by kind: discrete, integrated, virtual, CPU. With `REVMAP_VALIDATION=1` in the environment the validation
    /// layers watch every call.
    ///
    /// # Errors
    /// [`Stage::Device`] when there is none, or it lacks what is needed.
    pub fn open(choice: Option<&str>) -> Result<Self> {
        Self::on(Instance::from_environment()?, choice)
    }

    /// As [`Device::open`], with the validation layers on whatever the environment says: core checks and synchronization.
    ///
    /// # Errors
    /// As `open`, and [`Stage::Device`] when the layer is not installed.
    pub fn open_validated(choice: Option<&str>) -> Result<Self> {
        Self::on(Instance::new(true)?, choice)
    }

    fn on(instance: Instance, choice: Option<&str>) -> Result<Self> {
        let variable = std::env::var(DEVICE_VARIABLE)
            .ok()
            .filter(|v| !v.is_empty());
        let chosen = choose(candidates(&instance)?, choice.or(variable.as_deref()))?;
        Ok(Self {
            shared: Arc::new(Shared::new(instance, &chosen)?),
        })
    }

    /// What it is.
    #[must_use]
    pub fn report(&self) -> &DeviceReport {
        &self.shared.report
    }

    /// Takes the validation layers' messages since the last call; always empty without the layers.
    #[must_use]
    pub fn take_messages(&self) -> Vec<String> {
        self.shared
            .instance
            .messages
            .as_ref()
            .map(super::messages::Messages::take)
            .unwrap_or_default()
    }

    /// Fails when the validation layers have had anything to say since the last call.
    ///
    /// # Errors
    /// [`Stage::Draw`] with the first message and the number of them.
    pub fn check(&self) -> Result<()> {
        let messages = self.take_messages();
        match messages.first() {
            None => Ok(()),
            Some(first) => Err(Error::new(
                Stage::Draw,
                format!(
                    "{} messages of the validation layers, the first: {}",
                    messages.len(),
                    first.replace('\n', " ")
                ),
            )),
        }
    }

    /// Whether the validation layers watch.
    #[must_use]
    pub fn validated(&self) -> bool {
        self.shared.instance.messages.is_some()
    }
}

impl Shared {
    fn new(instance: Instance, chosen: &Candidate) -> Result<Self> {
        let priorities = [1.0];
        let queues = [vk::DeviceQueueCreateInfo::default()
            .queue_family_index(chosen.family)
            .queue_priorities(&priorities)];
        let features = vk::PhysicalDeviceFeatures {
            fragment_stores_and_atomics: vk::TRUE,
            sampler_anisotropy: vk::Bool32::from(chosen.anisotropic()),
            ..Default::default()
        };
        let mut extensions = Vec::new();
        if chosen.portability_subset {
            extensions.push(ash::khr::portability_subset::NAME.as_ptr());
        }
        let info = vk::DeviceCreateInfo::default()
            .queue_create_infos(&queues)
            .enabled_extension_names(&extensions)
            .enabled_features(&features);
        // SAFETY: `info` asks only for what the physical device offers.
        let raw = unsafe { instance.raw.create_device(chosen.physical, &info, None) }
            .call("vkCreateDevice")
            .map_err(super::instance::into_device)?;
        // SAFETY: the queue was asked for above.
        let queue = unsafe { raw.get_device_queue(chosen.family, 0) };
        const MIB: u64 = 1 << 20;
        let allocator = Allocator::new(&AllocatorCreateDesc {
            instance: instance.raw.clone(),
            device: raw.clone(),
            physical_device: chosen.physical,
            debug_settings: AllocatorDebugSettings::default(),
            buffer_device_address: false,
            allocation_sizes: AllocationSizes::new(8 * MIB, 4 * MIB)
                .with_max_device_memblock_size(128 * MIB)
                .with_max_host_memblock_size(64 * MIB),
        });
        let allocator = match allocator {
            Ok(allocator) => allocator,
            Err(e) => {
                // SAFETY: nothing was made on the device yet.
                unsafe { raw.destroy_device(None) };
                return Err(Error::new(
                    Stage::Device,
                    format!("no memory allocator: {e}"),
                ));
            }
        };
        Ok(Self {
            allocator: Some(Mutex::new(allocator)),
            raw,
            queue: Mutex::new(queue),
            family: chosen.family,
            limits: chosen.properties.limits,
            timestamp_bits: chosen.timestamp_bits,
            anisotropy: (features.sampler_anisotropy == vk::TRUE)
                .then_some(chosen.properties.limits.max_sampler_anisotropy),
            report: chosen.report.clone(),
            instance,
        })
    }

    pub fn allocator(&self) -> Result<MutexGuard<'_, Allocator>> {
        self.allocator
            .as_ref()
            .and_then(|a| a.lock().ok())
            .ok_or_else(|| Error::new(Stage::Draw, "the device's allocator is gone after a panic"))
    }
}

impl Drop for Shared {
    fn drop(&mut self) {
        // SAFETY: everything made on the device held this alive and is gone by now.
        unsafe {
            let _ = self.raw.device_wait_idle();
            self.allocator = None;
            self.raw.destroy_device(None);
        }
    }
}
