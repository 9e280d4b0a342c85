//! A device to draw on: opened here, or borrowed from a host.

use crate::error::{Error, ErrorKind, Result};
use crate::gpu::device::budget::MemoryUse;
use crate::gpu::device::instance::{API_VERSION, Instance};
use crate::gpu::device::report::{DeviceReport, choose, inspect, refuse};
use crate::gpu::device::{Shared, create};
use crate::gpu::memory::{Buffer, Image, ImageKind};
use crate::gpu::resources::geometry::Geometry;
use crate::gpu::vk::call::Call;
#[cfg(feature = "other-shaders")]
use crate::gpu::vk::pipelines::ShaderSource;
use ash::ext::debug_utils;
use ash::vk;
use gpu_allocator::vulkan::{Allocator, AllocatorCreateDesc};
use gpu_allocator::{AllocationSizes, AllocatorDebugSettings, MemoryLocation};
use std::sync::atomic::Ordering;
use std::sync::{Arc, Mutex, PoisonError, Weak};

/// A Vulkan device, with memory and pipelines that all its renderers share. Clones share them, too.
#[derive(Clone)]
pub struct Device {
    pub(crate) shared: Arc<Shared>,
    /// The geometry that renderers share, while there are any.
    pub(crate) geometry: Arc<Mutex<Weak<Mutex<Geometry>>>>,
}

impl From<Shared> for Device {
    fn from(shared: Shared) -> Self {
        Self {
            shared: Arc::new(shared),
            geometry: Arc::default(),
        }
    }
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
    /// A queue for [`Device::submit`]; renderers need none.
    pub queue: Option<vk::Queue>,
    /// The features that the device was opened with.
    pub features: vk::PhysicalDeviceFeatures,
    /// The host's allocator; without one a renderer makes its own.
    pub allocator: Option<Arc<Mutex<Allocator>>>,
    /// The host's pipeline cache; without one a renderer makes its own. Several threads may compile
    /// with it at once, so it is made without
    /// `VK_PIPELINE_CACHE_CREATE_EXTERNALLY_SYNCHRONIZED_BIT`.
    pub pipeline_cache: Option<vk::PipelineCache>,
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
    /// * `host.queue`, if given, is used by nothing else during [`Device::submit`];
    /// * `host.pipeline_cache`, if given, was made without
    ///   `VK_PIPELINE_CACHE_CREATE_EXTERNALLY_SYNCHRONIZED_BIT`, and nothing merges other caches
    ///   into it while pipelines are made: by [`Renderer::prepare`](crate::gpu::Renderer::prepare),
    ///   [`Renderer::record_prewarm`](crate::gpu::Renderer::record_prewarm) and
    ///   [`Prewarm::compile`](crate::gpu::Prewarm::compile).
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
        let shared = Shared::new(host.instance, candidate, raw, host.queue, memory, cache)?;
        Ok(shared.into())
    }

    /// Returns the same device with its own pipelines, made of the SPIR-V that `shaders` returns.
    /// Use it to compare other shaders with the library's. The new value keeps this value alive.
    ///
    /// # Errors
    /// Errors of Vulkan calls.
    ///
    /// # Safety
    /// The SPIR-V of `shaders` must be valid and have the interface of this version's shaders: their
    /// bindings, blocks and specialisation constants.
    #[cfg(feature = "other-shaders")]
    pub unsafe fn with_shaders(&self, shaders: ShaderSource) -> Result<Self> {
        let Shared {
            functions,
            chosen,
            raw,
            allocator,
            queue,
            ..
        } = &*self.shared;
        let memory = Arc::clone(allocator);
        let mut own = Shared::new(functions, chosen.clone(), raw.clone(), None, memory, None)?;
        own.pipelines.source = Some(shaders);
        own.queue.clone_from(queue);
        own.opened = Some(self.shared.clone());
        Ok(own.into())
    }

    /// Labels the commands and names the buffers of all renderers from now on, for debuggers of
    /// frames. No device does so by itself: validation layers 1.3.239 crashed in one of two runs of
    /// tests in which several threads recorded labels.
    ///
    /// # Safety
    /// The call loads functions. The caller must ensure that the host's instance was made with
    /// `VK_EXT_debug_utils`.
    pub unsafe fn enable_debug_labels(&self) {
        let shared = &self.shared;
        let functions = || debug_utils::Device::new(&shared.functions, &shared.raw);
        shared.debug_labels.get_or_init(functions);
    }

    /// Limits the bytes of all buffers and images on the device, including those of pictures.
    /// `None` allows as many as the device has. Earlier allocations count. Only an allocation that
    /// exceeds the budget fails.
    pub fn set_memory_budget(&self, bytes: Option<u64>) {
        let budget = self.shared.budget.lock();
        budget.unwrap_or_else(PoisonError::into_inner).limit = bytes;
    }

    /// The memory that all buffers and images on the device take.
    #[must_use]
    pub fn memory_use(&self) -> MemoryUse {
        let budget = self.shared.budget.lock();
        budget.unwrap_or_else(PoisonError::into_inner).used
    }

    fn on(instance: Instance, choice: Option<&str>) -> Result<Self> {
        let chosen = choose(&instance, choice)?;
        let raw = create(&instance, &chosen, &[], None)?;
        // SAFETY: the queue was requested when the device was made.
        let queue = unsafe { raw.get_device_queue(chosen.family, 0) };
        let functions = &instance.raw;
        let made = allocator(functions, chosen.physical, &raw).and_then(|memory| {
            Shared::new(functions, chosen, raw.clone(), Some(queue), memory, None)
        });
        match made {
            Ok(mut shared) => {
                shared.instance = Some(instance);
                Ok(shared.into())
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
        &self.shared.chosen.report
    }

    /// The number of pipelines that were compiled on the device.
    #[must_use]
    pub fn pipelines_compiled(&self) -> u64 {
        self.shared.pipelines.compiled.load(Ordering::Relaxed)
    }

    /// Adds the data that [`Device::pipeline_cache_data`] returned in another process. Pipelines
    /// that were compiled there are found instead of compiled. Data of another device or driver is
    /// ignored. Other threads may compile meanwhile.
    ///
    /// # Errors
    /// [`ErrorKind::Usage`] for damaged data and for data that [`Device::pipeline_cache_data`] did
    /// not write, which could crash a driver; also for a device that was borrowed with the host's
    /// cache. Errors of Vulkan calls.
    pub fn add_pipeline_cache(&self, data: &[u8]) -> Result<()> {
        let (pipelines, chosen) = (&self.shared.pipelines, &self.shared.chosen);
        pipelines.add_cache_bytes(data, &chosen.properties)
    }

    /// The driver's compiled pipelines, to be saved for [`Device::add_pipeline_cache`]. A mark and a
    /// hash precede the driver's own data.
    ///
    /// # Errors
    /// Errors of Vulkan calls.
    pub fn pipeline_cache_data(&self) -> Result<Vec<u8>> {
        self.shared.pipelines.cache_bytes()
    }

    /// The device's functions and handle, for other drawing on the device.
    #[must_use]
    pub fn raw(&self) -> &ash::Device {
        &self.shared.raw
    }

    /// The functions of the device's instance, for other drawing on the device.
    #[must_use]
    pub fn instance(&self) -> &ash::Instance {
        &self.shared.functions
    }

    /// The physical device.
    #[must_use]
    pub fn physical(&self) -> vk::PhysicalDevice {
        self.shared.chosen.physical
    }

    /// The family of the queues to which recorded commands are submitted.
    #[must_use]
    pub fn queue_family(&self) -> u32 {
        self.shared.chosen.family
    }

    /// Submits commands to the device's queue, one call after the other: threads may share it.
    ///
    /// # Errors
    /// [`ErrorKind::Usage`] if the device was borrowed without a queue; errors of Vulkan calls.
    ///
    /// # Safety
    /// The call submits `cmd`, which signals `fence` at its end.
    ///
    /// The caller must ensure that
    /// * `cmd` is of the device's family, recorded, and may be submitted; all that it uses lives until
    ///   it has run;
    /// * `fence` is null, or unsignaled and in no other submission.
    pub unsafe fn submit(&self, cmd: vk::CommandBuffer, fence: vk::Fence) -> Result<()> {
        let queue = self.shared.queue.as_ref();
        let queue = queue.and_then(|queue| queue.lock().ok()).ok_or_else(|| {
            let message = "the device has no queue to submit to; borrow it with one";
            Error::new(ErrorKind::Usage, message)
        })?;
        let buffers = [cmd];
        let submit = vk::SubmitInfo::default().command_buffers(&buffers);
        // SAFETY: as the caller promised; access to the queue is serialised by the lock.
        unsafe { self.raw().queue_submit(*queue, &[submit], fence) }.call("vkQueueSubmit")
    }

    /// The source of device memory, for other drawing on the device.
    ///
    /// # Errors
    /// None in this version.
    pub fn allocator(&self) -> Result<Arc<Mutex<Allocator>>> {
        Ok(Arc::clone(&self.shared.allocator))
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
        Buffer::new(&self.shared, name, bytes, usage, location, u32::MAX)
    }

    /// Makes an image for other drawing on the device, called `name` in messages. The image counts in
    /// the memory budget.
    ///
    /// # Errors
    /// Same as [`Device::buffer`].
    pub fn image(&self, name: &str, kind: ImageKind) -> Result<Image> {
        Image::new(&self.shared, name, kind)
    }

    /// Takes the validation layers' messages since the last call. The list is always empty without
    /// the layers, and for a borrowed device.
    #[must_use]
    pub fn take_messages(&self) -> Vec<String> {
        let instance = self.shared.instance.as_ref();
        instance.map(Instance::take_messages).unwrap_or_default()
    }

    /// Returns an error if the validation layers have sent any message since the last call.
    ///
    /// # Errors
    /// [`ErrorKind::Other`] with the first message and the number of them.
    pub fn check(&self) -> Result<()> {
        let messages = self.take_messages();
        let Some(first) = messages.first() else {
            return Ok(());
        };
        let (count, first) = (messages.len(), first.replace('\n', " "));
        let message = format!("{count} messages of the validation layers, the first: {first}");
        Err(Error::new(ErrorKind::Other, message))
    }

    /// Returns true if the validation layers are on.
    #[must_use]
    pub fn validated(&self) -> bool {
        let instance = self.shared.instance.as_ref();
        instance.is_some_and(Instance::validated)
    }
}

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

/// An allocator for devices whose host gives none.
fn allocator(
    instance: &ash::Instance,
    physical_device: vk::PhysicalDevice,
    device: &ash::Device,
) -> Result<Arc<Mutex<Allocator>>> {
    const MIB: u64 = 1 << 20;
    Allocator::new(&AllocatorCreateDesc {
        instance: instance.clone(),
        device: device.clone(),
        physical_device,
        debug_settings: AllocatorDebugSettings::default(),
        buffer_device_address: false,
        allocation_sizes: AllocationSizes::new(8 * MIB, 4 * MIB)
            .with_max_device_memblock_size(128 * MIB)
            .with_max_host_memblock_size(64 * MIB),
    })
    .map(|allocator| Arc::new(Mutex::new(allocator)))
    .map_err(|e| Error::new(ErrorKind::Other, format!("no memory allocator: {e}")))
}
