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

/// A Vulkan device and what all renderers on it share: memory and pipelines. Clones share it, too.
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
    /// The device, opened with what [`Requirements`](super::Requirements) lists.
    pub device: &'a ash::Device,
    /// The family of the queues to which recorded commands are submitted.
    pub queue_family: u32,
    /// A queue for [`Offscreen`](super::Offscreen), which submits by itself; renderers need none.
    pub queue: Option<vk::Queue>,
    /// The features that the device was opened with.
    pub features: vk::PhysicalDeviceFeatures,
    /// The host's allocator; without one a renderer makes its own.
    pub allocator: Option<Arc<Mutex<Allocator>>>,
    /// The host's pipeline cache; without one a renderer makes its own.
    pub pipeline_cache: Option<vk::PipelineCache>,
}

/// What everything made on a device keeps alive.
pub(crate) struct Shared {
    // Dropped before the device: see Drop.
    allocator: Option<Arc<Mutex<Allocator>>>,
    pipelines: Option<Pipelines>,
    pub raw: ash::Device,
    pub queue: Option<Arc<Mutex<vk::Queue>>>,
    pub family: u32,
    /// Of its instance.
    pub functions: ash::Instance,
    pub physical: vk::PhysicalDevice,
    /// Whether fragment shaders may write to buffers.
    pub fragment_stores: bool,
    pub limits: vk::PhysicalDeviceLimits,
    pub constants: DeviceConstants,
    /// Invocations that run together.
    pub subgroup_size: u32,
    pub timestamp_bits: u32,
    pub anisotropy: Option<f32>,
    /// As [`Candidate::clips`].
    pub clips: bool,
    /// As [`Candidate::most_draws`].
    pub most_draws: u32,
    /// What renderers share, while there are any.
    pub geometry: Mutex<Weak<Geometry>>,
    pub report: DeviceReport,
    pub budget: MemoryBudget,
    /// Bits of the types of memory that is the host's alone, coherent.
    pub host_types: u32,
    /// None of a borrowed device.
    instance: Option<Instance>,
    /// What must outlive this: of [`Device::with_shaders`] the device's own.
    #[cfg(feature = "other-shaders")]
    #[allow(dead_code)]
    opened: Option<Arc<Shared>>,
}

impl Device {
    /// Opens the device chosen by `choice` (index, or part of a name), else by the environment
    /// variable `REVMAP_DEVICE`, else the first by kind: discrete, integrated, virtual, CPU. With
    /// `REVMAP_VALIDATION=1` in the environment the validation layers watch every call.
    ///
    /// # Errors
    /// [`ErrorKind::Unsupported`] when there is none, or it lacks what is needed.
    pub fn open(choice: Option<&str>) -> Result<Self> {
        Self::on(Instance::from_environment()?, choice)
    }

    /// As [`Device::open`], with the validation layers on whatever the environment says: core
    /// checks and synchronization.
    ///
    /// # Errors
    /// As `open`, and [`ErrorKind::Unsupported`] when the layer is not installed.
    pub fn open_validated(choice: Option<&str>) -> Result<Self> {
        Self::on(Instance::new(true)?, choice)
    }

    /// Borrows a host's device.
    ///
    /// # Errors
    /// [`ErrorKind::Unsupported`] when the device lacks what is needed; of Vulkan.
    ///
    /// # Safety
    /// This call makes layouts, and an allocator and a pipeline cache where the host gives none.
    /// They are destroyed with the last of: this value, its clones, and all that was made with
    /// them.
    ///
    /// The caller must see to it that
    /// * all handles belong together and stay valid until then;
    /// * the device was opened with the features that `host.features` lists, on Vulkan 1.2 or
    ///   later;
    /// * `host.queue`, where there is one, is used by nobody else while an `Offscreen` submits.
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

    /// As [`Device::borrow`], with pipelines made of the SPIR-V that `shaders` gives: for work on
    /// the shaders while a program runs.
    ///
    /// # Errors
    /// As `borrow`.
    ///
    /// # Safety
    /// As `borrow`. What `shaders` gives is valid and has the interface of this version's shaders:
    /// their bindings, blocks and specialisation constants.
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

    /// The same device with pipelines of its own, made of the SPIR-V that `shaders` gives; it keeps
    /// this value alive.
    ///
    /// # Errors
    /// Of Vulkan.
    ///
    /// # Safety
    /// As of [`Device::borrow_with_shaders`], of `shaders`.
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

    /// Bounds the bytes of all buffers and images on the device, those of pictures included;
    /// `None`: as many as it has. What was taken before counts; what would exceed the budget fails,
    /// and nothing else does.
    pub fn set_memory_budget(&self, bytes: Option<u64>) {
        self.shared.budget.set(bytes);
    }

    /// What all buffers and images on the device take.
    #[must_use]
    pub fn memory_use(&self) -> MemoryUse {
        self.shared.budget.memory_use()
    }

    fn on(instance: Instance, choice: Option<&str>) -> Result<Self> {
        let variable = variable();
        let chosen = choose(candidates(&instance)?, choice.or(variable.as_deref()))?;
        let raw = create(&instance, &chosen, &[], None)?;
        // SAFETY: the queue was asked for when the device was made.
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
                // SAFETY: what was made on the device is gone again.
                unsafe { raw.destroy_device(None) };
                Err(error)
            }
        }
    }

    /// What it is.
    #[must_use]
    pub fn report(&self) -> &DeviceReport {
        &self.shared.report
    }

    /// How many pipelines have been compiled on it.
    #[must_use]
    pub fn pipelines_compiled(&self) -> u64 {
        self.shared.pipelines().map_or(0, Pipelines::compiled)
    }

    /// Adds what [`Device::pipeline_cache_data`] gave in another process: pipelines compiled there
    /// are found instead of compiled. Data of another driver is passed over.
    ///
    /// # Errors
    /// Of Vulkan.
    pub fn add_pipeline_cache(&self, data: &[u8]) -> Result<()> {
        self.shared.pipelines()?.add_cache(data)
    }

    /// The driver's compiled pipelines, to be kept for [`Device::add_pipeline_cache`].
    ///
    /// # Errors
    /// Of Vulkan.
    pub fn pipeline_cache_data(&self) -> Result<Vec<u8>> {
        self.shared.pipelines()?.cache_data()
    }

    /// The device's functions and handle, for what is drawn beside.
    #[must_use]
    pub fn raw(&self) -> &ash::Device {
        &self.shared.raw
    }

    /// Where device memory comes from, for what is drawn beside.
    ///
    /// # Errors
    /// [`ErrorKind::Other`] while the device is being closed.
    pub fn allocator(&self) -> Result<Arc<Mutex<Allocator>>> {
        let closed = || Error::new(ErrorKind::Other, "the device is being closed");
        self.shared.allocator.clone().ok_or_else(closed)
    }

    /// A buffer for what is drawn beside, called `name` in messages; it counts in the memory budget.
    ///
    /// # Errors
    /// Of Vulkan; [`ErrorKind::OutOfDeviceMemory`] beyond the budget, too.
    pub fn buffer(
        &self,
        name: &str,
        bytes: u64,
        usage: vk::BufferUsageFlags,
        location: MemoryLocation,
    ) -> Result<Buffer> {
        Buffer::new(&self.shared, name, bytes, usage, location)
    }

    /// Takes the validation layers' messages since the last call; always empty without the layers,
    /// and of a borrowed device.
    #[must_use]
    pub fn take_messages(&self) -> Vec<String> {
        self.messages()
            .map(crate::gpu::device::messages::Messages::take)
            .unwrap_or_default()
    }

    fn messages(&self) -> Option<&crate::gpu::device::messages::Messages> {
        self.shared.instance.as_ref()?.messages.as_ref()
    }

    /// Fails when the validation layers have had anything to say since the last call.
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

    /// Whether the validation layers watch.
    #[must_use]
    pub fn validated(&self) -> bool {
        self.messages().is_some()
    }
}

/// A device with the features that are used where they are offered, and with these extensions.
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
    // SAFETY: `info` asks only for what the physical device offers.
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
        // SAFETY: everything made on the device held this alive and is gone by now; a host has
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
