//! Devices: their requirements, opening one, borrowing a host's.

use crate::fault::{Fault, Outcome, RevmapResult, enter};
use crate::handle::{Handle, create, handle};
use crate::pointers::{list, optional_text, put_bytes};
use crate::structures::{described, fill, read, sized};
use ash::vk;
use ash::vk::Handle as _;
use revmap::gpu::{Device, HostDevice, Requirements};
use std::ffi::{c_char, c_void};

/// A Vulkan device, opened by the library or borrowed from a host. Objects made on it keep the
/// parts of it that they need.
pub struct RevmapDevice;
handle!(RevmapDevice, "device", Device);

/// `PFN_vkGetInstanceProcAddr`, which may be null.
#[repr(transparent)]
#[derive(Clone, Copy)]
pub struct GetInstanceProcAddr(pub Option<vk::PFN_vkGetInstanceProcAddr>);

/// Requirements for a device that a host lends. No device extension is needed.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct RevmapRequirements {
    /// sizeof(RevmapRequirements).
    pub size: u32,
    /// Least Vulkan version of the instance and the device, as VK_MAKE_API_VERSION.
    pub api_version: u32,
    /// The first queue family with graphics and compute.
    pub queue_family: u32,
    /// Features to enable; more may be. A host that draws REVMAP_PLANES_COLOR in a pass, without
    /// RevmapPass.sample_rays, needs none of them.
    pub features: vk::PhysicalDeviceFeatures,
}

/// A host's device.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct RevmapHostDevice {
    /// sizeof(RevmapHostDevice).
    pub size: u32,
    /// The family of the queues to which recorded commands are submitted.
    pub queue_family: u32,
    /// The host's vkGetInstanceProcAddr, through which all functions are found.
    pub get_instance_proc_addr: GetInstanceProcAddr,
    /// The instance.
    pub instance: vk::Instance,
    /// The physical device.
    pub physical_device: vk::PhysicalDevice,
    /// The device, of Vulkan 1.2 or later.
    pub device: vk::Device,
    /// A queue for RevmapOffscreen, which submits by itself; renderers need none. May be null.
    pub queue: vk::Queue,
    /// The features that the device was opened with; null: none.
    pub features: *const vk::PhysicalDeviceFeatures,
    /// A pipeline cache of the host's; may be null. Several threads may compile with it at once: it
    /// must be made without VK_PIPELINE_CACHE_CREATE_EXTERNALLY_SYNCHRONIZED_BIT, and nothing may
    /// merge other caches into it while pipelines are compiled.
    pub pipeline_cache: vk::PipelineCache,
}

/// Properties of a device.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct RevmapDeviceInfo {
    /// sizeof(RevmapDeviceInfo).
    pub size: u32,
    /// 1 if the library has opened it with the validation layers, else 0.
    pub validated: u32,
    /// Number of pipelines compiled on it so far.
    pub pipelines_compiled: u64,
    /// Name of the device, UTF-8, ended by 0.
    pub name: [c_char; 256],
    /// Driver's name and version, UTF-8, ended by 0.
    pub driver: [c_char; 256],
}

/// Bytes that all buffers and images on a device take, by kind of memory.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct RevmapMemoryUse {
    /// sizeof(RevmapMemoryUse).
    pub size: u32,
    /// 0.
    pub padding: u32,
    /// Device memory that the host cannot map: data that only the device touches.
    pub device: u64,
    /// Device memory that the host can map: data that changes every frame, if there is such memory.
    /// Integrated and software devices have no other.
    pub visible: u64,
    /// Host memory: data that is copied to the device once or read back, and data that changes
    /// every frame if the host can map no device memory.
    pub host: u64,
}

described! {
    RevmapRequirements { 0 => [size, api_version, queue_family, features] }
    RevmapHostDevice {
        0 => [
            size, queue_family, get_instance_proc_addr, instance, physical_device, device, queue,
            features, pipeline_cache,
        ]
    }
    RevmapDeviceInfo { 0 => [size, validated, pipelines_compiled, name, driver] }
    RevmapMemoryUse { 0 => [size, padding, device, visible, host] }
}

/// The functions of a host's instance.
unsafe fn instance_of(get: GetInstanceProcAddr, instance: vk::Instance) -> Outcome<ash::Instance> {
    let get_instance_proc_addr = get
        .0
        .ok_or_else(|| Fault::usage("get_instance_proc_addr is null"))?;
    if instance.is_null() {
        return Err(Fault::usage("the VkInstance is null"));
    }
    // SAFETY: the host's own function and instance.
    let known = unsafe { get_instance_proc_addr(instance, c"vkGetDeviceProcAddr".as_ptr()) };
    if known.is_none() {
        let message = "get_instance_proc_addr does not know vkGetDeviceProcAddr of this instance";
        return Err(Fault::usage(message));
    }
    let functions = ash::StaticFn {
        get_instance_proc_addr,
    };
    // SAFETY: as above.
    Ok(unsafe { ash::Instance::load(&functions, instance) })
}

/// Returns the requirements for a physical device that a host lends. The size of requirements must
/// be set.
///
/// Fails with REVMAP_RESULT_UNSUPPORTED for a device that lacks something; the text says what is
/// missing.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn revmap_requirements(
    get_instance_proc_addr: GetInstanceProcAddr,
    instance: vk::Instance,
    physical_device: vk::PhysicalDevice,
    requirements: *mut RevmapRequirements,
) -> RevmapResult {
    enter(|| {
        let functions = instance_of(get_instance_proc_addr, instance)?;
        if physical_device.is_null() {
            return Err(Fault::usage("the VkPhysicalDevice is null"));
        }
        let needs = Requirements::of(&functions, physical_device)?;
        if !needs.extensions.is_empty() {
            let message = "device extensions are needed, which this interface cannot name";
            return Err(Fault::new(RevmapResult::Internal, message));
        }
        let value = RevmapRequirements {
            api_version: needs.api_version,
            queue_family: needs.queue_family,
            features: needs.features,
            ..sized()
        };
        fill(requirements, value)
    })
}

/// Opens a device of the library's own. choice is its index or a part of its name; null takes the
/// environment's REVMAP_DEVICE, else the first of discrete, integrated, virtual and CPU devices.
/// validate, if not 0, switches the validation layers on, as does REVMAP_VALIDATION=1 in the
/// environment.
///
/// Fails with REVMAP_RESULT_UNSUPPORTED if no device meets the requirements.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn revmap_device_open(
    choice: *const c_char,
    validate: u32,
    device: *mut *mut RevmapDevice,
) -> RevmapResult {
    create(device, || {
        let choice = optional_text(choice, "choice")?;
        Ok(match validate {
            0 => Device::open(choice)?,
            _ => Device::open_validated(choice)?,
        })
    })
}

/// Borrows a host's device. All handles belong together. The handles must stay valid until this
/// handle and everything made with it are destroyed, and the device is idle.
///
/// Fails with REVMAP_RESULT_UNSUPPORTED for a device that lacks something.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn revmap_device_borrow(
    host: *const RevmapHostDevice,
    device: *mut *mut RevmapDevice,
) -> RevmapResult {
    create(device, || {
        let host = read(host)?;
        let instance = instance_of(host.get_instance_proc_addr, host.instance)?;
        if host.physical_device.is_null() || host.device.is_null() {
            return Err(Fault::usage("the VkPhysicalDevice or the VkDevice is null"));
        }
        let functions = ash::Device::load(instance.fp_v1_0(), host.device);
        let lent = HostDevice {
            instance: &instance,
            physical: host.physical_device,
            device: &functions,
            queue_family: host.queue_family,
            queue: (!host.queue.is_null()).then_some(host.queue),
            features: host.features.as_ref().copied().unwrap_or_default(),
            allocator: None,
            pipeline_cache: (!host.pipeline_cache.is_null()).then_some(host.pipeline_cache),
        };
        Ok(Device::borrow(&lent)?)
    })
}

/// Returns the properties of a device. The size of info must be set.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn revmap_device_info(
    device: *const RevmapDevice,
    info: *mut RevmapDeviceInfo,
) -> RevmapResult {
    enter(|| {
        let device = RevmapDevice::get(device)?;
        let value = RevmapDeviceInfo {
            validated: u32::from(device.validated()),
            pipelines_compiled: device.pipelines_compiled(),
            name: short(&device.report().name),
            driver: short(&device.report().driver),
            ..sized()
        };
        fill(info, value)
    })
}

/// The longest start of a text that fits, ended by 0.
fn short(text: &str) -> [c_char; 256] {
    let mut all = [0; 256];
    let end = text.floor_char_boundary(all.len() - 1);
    for (to, byte) in all.iter_mut().zip(text[..end].bytes()) {
        *to = byte.cast_signed() as c_char;
    }
    all
}

/// Fails with REVMAP_RESULT_OTHER if the validation layers have reported a message since the last
/// call. A borrowed device's host has its own messenger, and this function always succeeds.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn revmap_device_check(device: *const RevmapDevice) -> RevmapResult {
    enter(|| Ok(RevmapDevice::get(device)?.check()?))
}

/// Labels the commands and names the buffers of all renderers of a device from now on, for
/// debuggers of frames. The host's instance was made with VK_EXT_debug_utils.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn revmap_device_enable_debug_labels(
    device: *const RevmapDevice,
) -> RevmapResult {
    enter(|| {
        let device = RevmapDevice::get(device)?;
        // SAFETY: the caller's instance has the extension.
        unsafe { device.enable_debug_labels() };
        Ok(())
    })
}

/// Returns the memory that all buffers and images on a device take. The size of memory must be set.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn revmap_device_memory_use(
    device: *const RevmapDevice,
    memory: *mut RevmapMemoryUse,
) -> RevmapResult {
    enter(|| {
        let used = RevmapDevice::get(device)?.memory_use();
        let value = RevmapMemoryUse {
            device: used.device,
            visible: used.visible,
            host: used.host,
            ..sized()
        };
        fill(memory, value)
    })
}

/// Adds compiled pipelines that revmap_device_pipeline_cache() gave in another process. Data of
/// another device or driver is ignored. Damaged and other bytes are refused, and so are all for a
/// device that was borrowed with a pipeline cache.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn revmap_device_add_pipeline_cache(
    device: *const RevmapDevice,
    bytes: *const c_void,
    count: usize,
) -> RevmapResult {
    enter(|| {
        let bytes = list(bytes.cast::<u8>(), count, "bytes")?;
        Ok(RevmapDevice::get(device)?.add_pipeline_cache(bytes)?)
    })
}

/// Returns the driver's compiled pipelines, behind a mark and a hash. With null bytes, count becomes their number. Otherwise
/// count is the room in bytes, which must be large enough, and becomes the number of bytes written.
/// The number grows as pipelines are compiled.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn revmap_device_pipeline_cache(
    device: *const RevmapDevice,
    bytes: *mut c_void,
    count: *mut usize,
) -> RevmapResult {
    put_bytes(bytes, count, || {
        Ok(RevmapDevice::get(device)?.pipeline_cache_data()?)
    })
}

/// Destroys a device; null is none. Objects made with it stay usable.
#[unsafe(no_mangle)]
pub extern "C" fn revmap_device_destroy(device: *mut RevmapDevice) -> RevmapResult {
    enter(|| RevmapDevice::destroy(device))
}
