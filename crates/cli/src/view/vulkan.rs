//! The window's instance, device and memory.
#![allow(unsafe_code)] // raw handles: each use says what it promises

use ash::{ext, khr, vk};
use gpu_allocator::vulkan::Allocator;
use revmap::error::{Error, ErrorKind, Result};
use revmap::gpu::{
    Device, HostDevice, Requirements, ShaderSource, VALIDATION_VARIABLE, vulkan_error,
};
use std::ffi::{CStr, c_void};
use std::sync::atomic::{AtomicU32, Ordering};
use std::sync::{Arc, Mutex};
use winit::raw_window_handle::{HasDisplayHandle, HasWindowHandle};
use winit::window::Window;

/// A Vulkan call's failure, with its name.
pub fn vulkan<T>(result: std::result::Result<T, vk::Result>, call: &str) -> Result<T> {
    result.map_err(|code| vulkan_error(call, code))
}

fn device_error(message: impl std::fmt::Display) -> Error {
    Error::new(ErrorKind::Unsupported, message.to_string())
}

/// A device that draws into a window. Objects made on it must be dropped before it.
pub struct Vulkan {
    /// The allocator of all device memory; `None` while it is being closed.
    allocator: Option<Arc<Mutex<Allocator>>>,
    features: vk::PhysicalDeviceFeatures,
    pub device: ash::Device,
    pub physical: vk::PhysicalDevice,
    pub queue: vk::Queue,
    pub family: u32,
    pub surface: vk::SurfaceKHR,
    pub surfaces: khr::surface::Instance,
    /// Nanoseconds of a timestamp's step; 0 where the queue has none.
    pub timestamp_ns: f64,
    pub instance: ash::Instance,
    messenger: Option<(ext::debug_utils::Instance, vk::DebugUtilsMessengerEXT)>,
    /// Messages of the validation layers.
    messages: Box<AtomicU32>,
    _entry: ash::Entry,
}

unsafe extern "system" fn message(
    _: vk::DebugUtilsMessageSeverityFlagsEXT,
    _: vk::DebugUtilsMessageTypeFlagsEXT,
    data: *const vk::DebugUtilsMessengerCallbackDataEXT<'_>,
    count: *mut c_void,
) -> vk::Bool32 {
    // SAFETY: the layers hand over a live message, and the counter that was registered with it.
    let text = unsafe {
        (*count.cast::<AtomicU32>()).fetch_add(1, Ordering::Relaxed);
        CStr::from_ptr((*data).p_message).to_string_lossy()
    };
    crate::output::note(&format!("validation: {text}"));
    vk::FALSE
}

impl Vulkan {
    /// Opens the device that `choice` names by its index or a part of its name. Without `choice`,
    /// opens the first by kind that can show pictures in `window`.
    pub fn open(window: &Window, choice: Option<&str>) -> Result<Self> {
        let validate =
            std::env::var_os(VALIDATION_VARIABLE).is_some_and(|v| v != "0" && !v.is_empty());
        let handle = |e| device_error(format!("the window has no handle: {e}"));
        let display = window.display_handle().map_err(handle)?.as_raw();
        let raw_window = window.window_handle().map_err(handle)?.as_raw();
        // SAFETY: plain creations in order; what follows a failure is destroyed by the process's
        // end.
        unsafe {
            let entry = ash::Entry::load()
                .map_err(|e| device_error(format!("no Vulkan loader ({e}); install libvulkan1")))?;
            let mut extensions = vulkan(
                ash_window::enumerate_required_extensions(display),
                "the window's extensions",
            )?
            .to_vec();
            let layers = [c"VK_LAYER_KHRONOS_validation".as_ptr()];
            let checks = [vk::ValidationFeatureEnableEXT::SYNCHRONIZATION_VALIDATION];
            let mut checked =
                vk::ValidationFeaturesEXT::default().enabled_validation_features(&checks);
            let application = vk::ApplicationInfo::default()
                .application_name(c"revmap")
                .api_version(vk::API_VERSION_1_3);
            if validate {
                extensions.extend([
                    ext::debug_utils::NAME.as_ptr(),
                    ext::validation_features::NAME.as_ptr(),
                ]);
            }
            let mut info = vk::InstanceCreateInfo::default()
                .application_info(&application)
                .enabled_extension_names(&extensions);
            if validate {
                info = info.enabled_layer_names(&layers).push_next(&mut checked);
            }
            let instance = vulkan(entry.create_instance(&info, None), "vkCreateInstance")?;
            let messages = Box::<AtomicU32>::default();
            let messenger = if validate {
                let functions = ext::debug_utils::Instance::new(&entry, &instance);
                type Severity = vk::DebugUtilsMessageSeverityFlagsEXT;
                type Kind = vk::DebugUtilsMessageTypeFlagsEXT;
                let info = vk::DebugUtilsMessengerCreateInfoEXT::default()
                    .message_severity(Severity::WARNING | Severity::ERROR)
                    .message_type(Kind::GENERAL | Kind::VALIDATION | Kind::PERFORMANCE)
                    .pfn_user_callback(Some(message))
                    .user_data((&raw const *messages).cast_mut().cast());
                let made = functions.create_debug_utils_messenger(&info, None);
                Some((functions, vulkan(made, "vkCreateDebugUtilsMessengerEXT")?))
            } else {
                None
            };
            let surface = ash_window::create_surface(&entry, &instance, display, raw_window, None);
            let surface = vulkan(surface, "the window's surface")?;
            let surfaces = khr::surface::Instance::new(&entry, &instance);
            let (physical, needs) = choose(&instance, &surfaces, surface, choice)?;
            let family = needs.queue_family;
            let priorities = [1.0];
            let queues = [vk::DeviceQueueCreateInfo::default()
                .queue_family_index(family)
                .queue_priorities(&priorities)];
            let mut newer = vk::PhysicalDeviceVulkan13Features::default().dynamic_rendering(true);
            let wanted = [khr::swapchain::NAME.as_ptr()];
            let info = vk::DeviceCreateInfo::default()
                .queue_create_infos(&queues)
                .enabled_extension_names(&wanted)
                .enabled_features(&needs.features)
                .push_next(&mut newer);
            let device = vulkan(
                instance.create_device(physical, &info, None),
                "vkCreateDevice",
            )?;
            let queue = device.get_device_queue(family, 0);
            let families = instance.get_physical_device_queue_family_properties(physical);
            let limits = instance.get_physical_device_properties(physical).limits;
            let timed = families
                .get(family as usize)
                .is_some_and(|f| f.timestamp_valid_bits == 64);
            let mut host = Self {
                allocator: None,
                features: needs.features,
                device,
                physical,
                queue,
                family,
                surface,
                surfaces,
                timestamp_ns: if timed {
                    f64::from(limits.timestamp_period)
                } else {
                    0.0
                },
                instance,
                messenger,
                messages,
                _entry: entry,
            };
            // The first borrower makes an allocator, which all others share.
            host.allocator = Some(host.lend(None)?.allocator()?);
            Ok(host)
        }
    }

    /// Lends the device to renderers, whose shaders may differ from the built-in ones. Everything
    /// made with it must be dropped before this host.
    pub fn lend(&self, shaders: Option<ShaderSource>) -> Result<Device> {
        let host = HostDevice {
            instance: &self.instance,
            physical: self.physical,
            device: &self.device,
            queue_family: self.family,
            queue: Some(self.queue), // of the one thread that draws
            features: self.features,
            allocator: self.allocator.clone(),
            pipeline_cache: None,
        };
        // SAFETY: the handles belong together and live as long as `self`; shaders are those of the
        // source tree, as somebody works on them.
        unsafe {
            match shaders {
                Some(shaders) => Device::borrow_with_shaders(&host, shaders),
                None => Device::borrow(&host),
            }
        }
    }

    /// The allocator of all device memory.
    pub fn allocator(&self) -> Result<&Arc<Mutex<Allocator>>> {
        let closed = || Error::new(ErrorKind::Other, "the device is being closed");
        self.allocator.as_ref().ok_or_else(closed)
    }

    pub fn wait(&self) {
        // SAFETY: plain call; what it says would come again from the next one.
        let _ = unsafe { self.device.device_wait_idle() };
    }

    /// Fails if the validation layers have reported a message.
    pub fn check(&self) -> Result<()> {
        match self.messages.load(Ordering::Relaxed) {
            0 => Ok(()),
            n => Err(Error::new(
                ErrorKind::Other,
                format!("{n} messages of the validation layers"),
            )),
        }
    }
}

impl Drop for Vulkan {
    fn drop(&mut self) {
        self.wait();
        self.allocator = None;
        // SAFETY: all that was made on the device is gone.
        unsafe {
            self.device.destroy_device(None);
            self.surfaces.destroy_surface(self.surface, None);
            if let Some((functions, messenger)) = &self.messenger {
                functions.destroy_debug_utils_messenger(*messenger, None);
            }
            self.instance.destroy_instance(None);
        }
    }
}

/// The named device, or the best by kind, among those that can draw and present.
unsafe fn choose(
    instance: &ash::Instance,
    surfaces: &khr::surface::Instance,
    surface: vk::SurfaceKHR,
    choice: Option<&str>,
) -> Result<(vk::PhysicalDevice, Requirements)> {
    let variable = std::env::var(revmap::gpu::DEVICE_VARIABLE)
        .ok()
        .filter(|v| !v.is_empty());
    let choice = choice.or(variable.as_deref()).map(str::to_lowercase);
    let mut refused = device_error(match &choice {
        None => "no Vulkan device shows pictures in this window; install a driver".to_owned(),
        Some(choice) => {
            format!("no device {choice} shows pictures in this window; `revmap devices` lists all")
        }
    });
    let mut found = Vec::new();
    // SAFETY: plain queries of live handles.
    unsafe {
        let all = vulkan(
            instance.enumerate_physical_devices(),
            "vkEnumeratePhysicalDevices",
        )?;
        // A number is an index, unless there are fewer devices.
        let number = choice.as_ref().and_then(|c| c.parse::<usize>().ok());
        let number = number.filter(|n| *n < all.len());
        for (index, physical) in all.into_iter().enumerate() {
            let properties = instance.get_physical_device_properties(physical);
            let name = properties
                .device_name_as_c_str()
                .unwrap_or_default()
                .to_string_lossy()
                .to_lowercase();
            let named = match (number, &choice) {
                (Some(number), _) => number == index,
                (None, Some(part)) => name.contains(part.as_str()),
                (None, None) => true,
            };
            if !named {
                continue;
            }
            let needs = match Requirements::of(instance, physical) {
                Ok(needs) => needs,
                Err(error) => {
                    refused = error;
                    continue;
                }
            };
            let shows =
                surfaces.get_physical_device_surface_support(physical, needs.queue_family, surface);
            if properties.api_version >= vk::API_VERSION_1_3 && shows == Ok(true) {
                let rank = match properties.device_type {
                    vk::PhysicalDeviceType::DISCRETE_GPU => 0,
                    vk::PhysicalDeviceType::INTEGRATED_GPU => 1,
                    vk::PhysicalDeviceType::VIRTUAL_GPU => 2,
                    _ => 3,
                };
                found.push((rank, physical, needs));
            }
        }
    }
    let best = found.into_iter().min_by_key(|(rank, ..)| *rank);
    best.map(|(_, physical, needs)| (physical, needs))
        .ok_or(refused)
}
