//! A device to draw on: opened here, or borrowed from a host.

pub(crate) mod instance;
pub(crate) mod messages;
pub(crate) mod report;
pub(crate) mod requirements;

use crate::error::{Error, ErrorKind, Result};
use crate::gpu::device::instance::Instance;
use crate::gpu::device::report::{
    Candidate, DeviceReport, candidates, choose, inspect, refuse, variable,
};
use crate::gpu::memory::budget::{MemoryBudget, MemoryUse};
use crate::gpu::memory::{Buffer, allocator, host_types};
use crate::gpu::resources::geometry::Geometry;
use crate::gpu::vk::call::Call;
use crate::gpu::vk::pipelines::{DeviceConstants, Pipelines};
use ash::vk;
use gpu_allocator::MemoryLocation;
use gpu_allocator::vulkan::Allocator;
use std::ffi::CStr;
use std::sync::{Arc, Mutex, MutexGuard, Weak};

/// A Vulkan device, with memory and pipelines that all its renderers share. Clones share them, too.
#[derive(Clone)]
pub struct Device {
    pub(crate) shared: Arc<Shared>,
}

/// A host's device, to be borrowed.
#[derive(Clone)]
pub struct HostDevice<'a> {
    /// The instance that the device belongs to.
    pub instance: &'a ash::Instance,
    /// The physical device.
    pub physical: vk::PhysicalDevice,
    /// The device, opened with everything that [`Requirements`](crate::gpu::Requirements) lists.
    pub device: &'a ash::Device,
    /// The family of the queues to which recorded commands are submitted.
    pub queue_family: u32,
    /// A queue for [`Offscreen`](crate::gpu::Offscreen), which submits by itself; renderers need none.
    pub queue: Option<vk::Queue>,
    /// The features that the device was opened with.
    pub features: vk::PhysicalDeviceFeatures,
    /// The host's allocator; without one a renderer makes its own.
    pub allocator: Option<Arc<Mutex<Allocator>>>,
    /// The host's pipeline cache; without one a renderer makes its own.
    pub pipeline_cache: Option<vk::PipelineCache>,
}

/// The state of a device, which everything made on it keeps alive.
pub(crate) struct Shared {
    // Dropped before the device: see Drop.
    allocator: Option<Arc<Mutex<Allocator>>>,
    pipelines: Option<Pipelines>,
    pub raw: ash::Device,
    pub queue: Option<Arc<Mutex<vk::Queue>>>,
    pub family: u32,
    /// The functions of the instance.
    pub functions: ash::Instance,
    pub physical: vk::PhysicalDevice,
    /// True if fragment shaders may write to buffers.
    pub fragment_stores: bool,
    pub limits: vk::PhysicalDeviceLimits,
    pub constants: DeviceConstants,
    /// The number of invocations that run together.
    pub subgroup_size: u32,
    pub timestamp_bits: u32,
    pub anisotropy: Option<f32>,
    /// Same as [`Candidate::clips`].
    pub clips: bool,
    /// Same as [`Candidate::most_draws`].
    pub most_draws: u32,
    /// The geometry that renderers share, while there are any.
    pub geometry: Mutex<Weak<Geometry>>,
    pub report: DeviceReport,
    pub budget: MemoryBudget,
    /// Bits of the memory types that are host-visible and coherent, but not device-local.
    pub host_types: u32,
    /// `None` for a borrowed device.
    instance: Option<Instance>,
    /// The device that [`Device::with_shaders`] was called on; it must outlive this one.
    #[cfg(feature = "other-shaders")]
    #[allow(dead_code)]
    opened: Option<Arc<Shared>>,
}

impl Device {
    /// Opens the device chosen by `choice` (index, or part of a name), else by the environment
    /// variable `REVMAP_DEVICE`, else the first by kind: discrete, integrated, virtual, CPU. With
    /// `REVMAP_VALIDATION=1` in the environment the validation layers check every call.
    ///
    /// # Errors
    /// [`ErrorKind::Unsupported`] if there is no device, or if the device lacks a requirement.
    pub fn open(choice: Option<&str>) -> Result<Self> {
        Self::on(Instance::from_environment()?, choice)
    }

    /// Same as [`Device::open`], with the validation layers on whatever the environment says: core
    /// checks and synchronization.
    ///
    /// # Errors
    /// Same as [`Device::open`], and [`ErrorKind::Unsupported`] if the layer is not installed.
    pub fn open_validated(choice: Option<&str>) -> Result<Self> {
        Self::on(Instance::new(true)?, choice)
    }

    /// Borrows a host's device.
    ///
    /// # Errors
    /// [`ErrorKind::Unsupported`] if the device lacks a requirement; errors of Vulkan calls.
    ///
    /// # Safety
    /// The call makes layouts. An allocator and a pipeline cache are made if the host gives none.
    /// All are destroyed with the last of: this value, its clones, and everything that was made
    /// with them.
    ///
    /// The caller must ensure that
    /// * all handles belong together and stay valid until that destruction;
    /// * the device was opened with the features that `host.features` lists, on Vulkan 1.2 or
    ///   later;
    /// * `host.queue`, if given, is used by nothing else while an `Offscreen` submits.
    pub unsafe fn borrow(host: &HostDevice<'_>) -> Result<Self> {
        let mut candidate = inspect(host.instance, 0, host.physical);
        refuse(&candidate)?;
        candidate.features = host.features;
        candidate.family = host.queue_family;
        let memory = match &host.allocator {
            Some(shared) => shared.clone(),
            None => allocator(host.instance, host.physical, host.device)?,
        };
        let (raw, cache) = (host.device.clone(), host.pipeline_cache);
        let shared = Shared::new(host.instance, &candidate, raw, host.queue, memory, cache)?;
        Ok(Self {
            shared: Arc::new(shared),
        })
    }

    /// Same as [`Device::borrow`], with pipelines made of the SPIR-V that `shaders` returns. Use it
    /// to work on shaders while a program runs.
    ///
    /// # Errors
    /// Same as [`Device::borrow`].
    ///
    /// # Safety
    /// Same as [`Device::borrow`]. The SPIR-V of `shaders` must be valid and have the interface of
    /// this version's shaders: their bindings, blocks and specialisation constants.
    #[cfg(feature = "other-shaders")]
    pub unsafe fn borrow_with_shaders(
        host: &HostDevice<'_>,
        shaders: super::ShaderSource,
    ) -> Result<Self> {
        // SAFETY: as the caller promised.
        let mut device = unsafe { Self::borrow(host) }?;
        let shared = Arc::get_mut(&mut device.shared);
        if let Some(pipelines) = shared.and_then(|shared| shared.pipelines.as_mut()) {
            pipelines.source = Some(shaders);
        }
        Ok(device)
    }

    /// Returns the same device with its own pipelines, made of the SPIR-V that `shaders` returns.
    /// The new value keeps this value alive.
    ///
    /// # Errors
    /// Errors of Vulkan calls.
    ///
    /// # Safety
    /// Same as [`Device::borrow_with_shaders`], for `shaders`.
    #[cfg(feature = "other-shaders")]
    pub unsafe fn with_shaders(&self, shaders: super::ShaderSource) -> Result<Self> {
        let shared = &self.shared;
        let mut pipelines = Pipelines::new(shared.raw.clone(), None, shared.constants)?;
        pipelines.source = Some(shaders);
        let own = Shared {
            allocator: shared.allocator.clone(),
            pipelines: Some(pipelines),
            raw: shared.raw.clone(),
            queue: shared.queue.clone(),
            family: shared.family,
            functions: shared.functions.clone(),
            physical: shared.physical,
            fragment_stores: shared.fragment_stores,
            limits: shared.limits,
            constants: shared.constants,
            subgroup_size: shared.subgroup_size,
            timestamp_bits: shared.timestamp_bits,
            anisotropy: shared.anisotropy,
            clips: shared.clips,
            most_draws: shared.most_draws,
            geometry: Mutex::default(),
            report: shared.report.clone(),
            budget: MemoryBudget::default(),
            host_types: shared.host_types,
            instance: None,
            opened: Some(shared.clone()),
        };
        Ok(Self {
            shared: Arc::new(own),
        })
    }

    /// Limits the bytes of all buffers and images on the device, including those of pictures.
    /// `None` allows as many as the device has. Earlier allocations count. Only an allocation that
    /// exceeds the budget fails.
    pub fn set_memory_budget(&self, bytes: Option<u64>) {
        self.shared.budget.set(bytes);
    }

    /// The memory that all buffers and images on the device take.
    #[must_use]
    pub fn memory_use(&self) -> MemoryUse {
        self.shared.budget.memory_use()
    }

    fn on(instance: Instance, choice: Option<&str>) -> Result<Self> {
        let variable = variable();
        let chosen = choose(candidates(&instance)?, choice.or(variable.as_deref()))?;
        let raw = create(&instance, &chosen, &[], None)?;
        // SAFETY: the queue was requested when the device was made.
        let queue = unsafe { raw.get_device_queue(chosen.family, 0) };
        let made = allocator(&instance.raw, chosen.physical, &raw).and_then(|memory| {
            Shared::new(
                &instance.raw,
                &chosen,
                raw.clone(),
                Some(queue),
                memory,
                None,
            )
        });
        match made {
            Ok(mut shared) => {
                shared.instance = Some(instance);
                Ok(Self {
                    shared: Arc::new(shared),
                })
            }
            Err(error) => {
                // SAFETY: everything that was made on the device is gone again.
                unsafe { raw.destroy_device(None) };
                Err(error)
            }
        }
    }

    /// The description of the device.
    #[must_use]
    pub fn report(&self) -> &DeviceReport {
        &self.shared.report
    }

    /// The number of pipelines that were compiled on the device.
    #[must_use]
    pub fn pipelines_compiled(&self) -> u64 {
        self.shared.pipelines().map_or(0, Pipelines::compiled)
    }

    /// Adds the data that [`Device::pipeline_cache_data`] returned in another process. Pipelines
    /// that were compiled there are found instead of compiled. Data of another driver is ignored.
    ///
    /// # Errors
    /// Errors of Vulkan calls.
    pub fn add_pipeline_cache(&self, data: &[u8]) -> Result<()> {
        self.shared.pipelines()?.add_cache(data)
    }

    /// The driver's compiled pipelines, to be saved for [`Device::add_pipeline_cache`].
    ///
    /// # Errors
    /// Errors of Vulkan calls.
    pub fn pipeline_cache_data(&self) -> Result<Vec<u8>> {
        self.shared.pipelines()?.cache_data()
    }

    /// The device's functions and handle, for other drawing on the device.
    #[must_use]
    pub fn raw(&self) -> &ash::Device {
        &self.shared.raw
    }

    /// The source of device memory, for other drawing on the device.
    ///
    /// # Errors
    /// [`ErrorKind::Other`] while the device is being closed.
    pub fn allocator(&self) -> Result<Arc<Mutex<Allocator>>> {
        let closed = || Error::new(ErrorKind::Other, "the device is being closed");
        self.shared.allocator.clone().ok_or_else(closed)
    }

    /// Makes a buffer for other drawing on the device, called `name` in messages. The buffer counts
    /// in the memory budget.
    ///
    /// # Errors
    /// Errors of Vulkan calls; [`ErrorKind::OutOfDeviceMemory`] also beyond the budget.
    pub fn buffer(
        &self,
        name: &str,
        bytes: u64,
        usage: vk::BufferUsageFlags,
        location: MemoryLocation,
    ) -> Result<Buffer> {
        Buffer::new(&self.shared, name, bytes, usage, location)
    }

    /// Takes the validation layers' messages since the last call. The list is always empty without
    /// the layers, and for a borrowed device.
    #[must_use]
    pub fn take_messages(&self) -> Vec<String> {
        self.messages()
            .map(crate::gpu::device::messages::Messages::take)
            .unwrap_or_default()
    }

    fn messages(&self) -> Option<&crate::gpu::device::messages::Messages> {
        self.shared.instance.as_ref()?.messages.as_ref()
    }

    /// Returns an error if the validation layers have sent any message since the last call.
    ///
    /// # Errors
    /// [`ErrorKind::Other`] with the first message and the number of them.
    pub fn check(&self) -> Result<()> {
        let messages = self.take_messages();
        match messages.first() {
            None => Ok(()),
            Some(first) => Err(Error::new(
                ErrorKind::Other,
                format!(
                    "{} messages of the validation layers, the first: {}",
                    messages.len(),
                    first.replace('\n', " ")
                ),
            )),
        }
    }

    /// Returns true if the validation layers are on.
    #[must_use]
    pub fn validated(&self) -> bool {
        self.messages().is_some()
    }
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
    fn new(
        instance: &ash::Instance,
        chosen: &Candidate,
        raw: ash::Device,
        queue: Option<vk::Queue>,
        memory: Arc<Mutex<Allocator>>,
        pipeline_cache: Option<vk::PipelineCache>,
    ) -> Result<Self> {
        let limits = chosen.properties.limits;
        let constants = DeviceConstants::of(chosen);
        let pipelines = Pipelines::new(raw.clone(), pipeline_cache, constants)?;
        Ok(Self {
            allocator: Some(memory),
            pipelines: Some(pipelines),
            queue: queue.map(|queue| Arc::new(Mutex::new(queue))),
            family: chosen.family,
            functions: instance.clone(),
            physical: chosen.physical,
            fragment_stores: chosen.features.fragment_stores_and_atomics == vk::TRUE,
            limits,
            constants,
            subgroup_size: chosen.subgroup_size,
            timestamp_bits: chosen.timestamp_bits,
            anisotropy: chosen
                .anisotropic()
                .then_some(limits.max_sampler_anisotropy),
            clips: chosen.clips(),
            most_draws: chosen.most_draws(),
            geometry: Mutex::default(),
            budget: MemoryBudget::default(),
            host_types: host_types(instance, chosen.physical),
            report: chosen.report.clone(),
            raw,
            instance: None,
            #[cfg(feature = "other-shaders")]
            opened: None,
        })
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
