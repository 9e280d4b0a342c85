//! A small engine that the examples share: instance, device, images, passes, meshes, frames in flight.
//! [`lend`] and [`solids`] alone know revmap.
#![allow(dead_code, unused_imports)] // each example takes what it needs

pub mod attachments;
pub mod commands;
pub mod lend;
pub mod memory;
mod mesh;
pub mod set;
pub mod solids;
mod stage;

pub use attachments::Attachments;
pub use commands::{Commands, commands};
/// From the world to a view along -z from an eye to a target: `look(eye, target, up)`.
pub use glam::dcamera::rh::view::look_at_mat4 as look;
pub use mesh::{Mesh, MeshPipeline, MeshShaders, module};
pub use stage::Stage;

use ash::{ext, vk};
use glam::{DMat4, DVec3, DVec4};
use std::error::Error;
use std::ffi::{CStr, c_void};
use std::sync::Mutex;

pub type Fallible<T> = Result<T, Box<dyn Error>>;

/// How a host draws.
#[derive(Clone, Copy, Debug)]
pub struct Options {
    pub width: u32,
    pub height: u32,
    /// Dynamic rendering, or a render pass.
    pub dynamic: bool,
    /// 1 or 4.
    pub samples: u32,
    /// Depth 1 is near.
    pub reversed: bool,
}

impl Options {
    /// Dynamic rendering of one sample, depth 0 near.
    pub const fn new(width: u32, height: u32) -> Self {
        Self {
            width,
            height,
            dynamic: true,
            samples: 1,
            reversed: false,
        }
    }

    pub fn extent(&self) -> vk::Extent2D {
        vk::Extent2D {
            width: self.width,
            height: self.height,
        }
    }
}

pub const COLOR: vk::Format = vk::Format::R8G8B8A8_SRGB;
pub const DEPTH: vk::Format = vk::Format::D32_SFLOAT;
pub const FRAMES: usize = 2;

/// An instance and a device, with the validation layers where asked for.
pub struct Host {
    pub instance: ash::Instance,
    pub physical: vk::PhysicalDevice,
    pub device: ash::Device,
    pub family: u32,
    pub queue: vk::Queue,
    pub features: vk::PhysicalDeviceFeatures,
    messenger: Option<(ext::debug_utils::Instance, vk::DebugUtilsMessengerEXT)>,
    messages: Box<Mutex<Vec<String>>>,
    /// Loads functions.
    pub entry: ash::Entry,
}

unsafe extern "system" fn keep(
    _: vk::DebugUtilsMessageSeverityFlagsEXT,
    _: vk::DebugUtilsMessageTypeFlagsEXT,
    data: *const vk::DebugUtilsMessengerCallbackDataEXT<'_>,
    store: *mut c_void,
) -> vk::Bool32 {
    // SAFETY: the layers hand over a live message, and the store that was registered with it.
    unsafe {
        let text = CStr::from_ptr((*data).p_message).to_string_lossy();
        if let Ok(mut all) = (*store.cast::<Mutex<Vec<String>>>()).lock() {
            all.push(text.into_owned());
        }
    }
    vk::FALSE
}

impl Host {
    /// Opens a device; `requirements` says what has to be enabled on it.
    pub fn open(
        validate: bool,
        requirements: impl Fn(
            &ash::Instance,
            vk::PhysicalDevice,
        ) -> Fallible<(u32, vk::PhysicalDeviceFeatures)>,
    ) -> Fallible<Self> {
        // SAFETY: plain creations in order; everything is destroyed in Drop.
        unsafe {
            let entry = ash::Entry::load()?;
            let layer = [c"VK_LAYER_KHRONOS_validation".as_ptr()];
            let extensions = [
                ext::debug_utils::NAME.as_ptr(),
                ext::validation_features::NAME.as_ptr(),
            ];
            let checks = [vk::ValidationFeatureEnableEXT::SYNCHRONIZATION_VALIDATION];
            let mut checked =
                vk::ValidationFeaturesEXT::default().enabled_validation_features(&checks);
            let application = vk::ApplicationInfo::default().api_version(vk::API_VERSION_1_3);
            let mut info = vk::InstanceCreateInfo::default().application_info(&application);
            if validate {
                info = info
                    .enabled_layer_names(&layer)
                    .enabled_extension_names(&extensions)
                    .push_next(&mut checked);
            }
            let instance = entry.create_instance(&info, None)?;
            let messages = Box::<Mutex<Vec<String>>>::default();
            let mut messenger = None;
            if validate {
                let functions = ext::debug_utils::Instance::new(&entry, &instance);
                type Severity = vk::DebugUtilsMessageSeverityFlagsEXT;
                type Kind = vk::DebugUtilsMessageTypeFlagsEXT;
                let info = vk::DebugUtilsMessengerCreateInfoEXT::default()
                    .message_severity(Severity::WARNING | Severity::ERROR)
                    .message_type(Kind::GENERAL | Kind::VALIDATION | Kind::PERFORMANCE)
                    .pfn_user_callback(Some(keep))
                    .user_data((&raw const *messages).cast_mut().cast());
                let made = functions.create_debug_utils_messenger(&info, None)?;
                messenger = Some((functions, made));
            }
            let mut refused: Box<dyn Error> = "no Vulkan device".into();
            for physical in instance.enumerate_physical_devices()? {
                let (family, features) = match requirements(&instance, physical) {
                    Ok(found) => found,
                    Err(error) => {
                        refused = error;
                        continue;
                    }
                };
                let priorities = [1.0];
                let queues = [vk::DeviceQueueCreateInfo::default()
                    .queue_family_index(family)
                    .queue_priorities(&priorities)];
                let mut newer =
                    vk::PhysicalDeviceVulkan13Features::default().dynamic_rendering(true);
                let info = vk::DeviceCreateInfo::default()
                    .queue_create_infos(&queues)
                    .enabled_features(&features)
                    .push_next(&mut newer);
                let device = instance.create_device(physical, &info, None)?;
                let queue = device.get_device_queue(family, 0);
                return Ok(Self {
                    instance,
                    physical,
                    device,
                    family,
                    queue,
                    features,
                    messenger,
                    messages,
                    entry,
                });
            }
            Err(refused)
        }
    }

    /// What the validation layers have said since the last call.
    pub fn take_messages(&self) -> Vec<String> {
        let all = self.messages.lock();
        all.map(|mut all| std::mem::take(&mut *all))
            .unwrap_or_default()
    }

    pub fn memory(
        &self,
        needs: vk::MemoryRequirements,
        wanted: vk::MemoryPropertyFlags,
    ) -> Fallible<vk::DeviceMemory> {
        // SAFETY: plain query and creation.
        unsafe {
            let instance = &self.instance;
            let all = instance.get_physical_device_memory_properties(self.physical);
            let fits = |n: &u32| {
                needs.memory_type_bits & (1 << n) != 0
                    && all.memory_types[*n as usize]
                        .property_flags
                        .contains(wanted)
            };
            let kind = (0..all.memory_type_count).find(fits);
            let kind = kind.ok_or("no such memory")?;
            let info = vk::MemoryAllocateInfo::default()
                .allocation_size(needs.size)
                .memory_type_index(kind);
            Ok(self.device.allocate_memory(&info, None)?)
        }
    }
}

impl Drop for Host {
    fn drop(&mut self) {
        // SAFETY: everything made on the device is gone.
        unsafe {
            self.device.destroy_device(None);
            if let Some((functions, messenger)) = &self.messenger {
                functions.destroy_debug_utils_messenger(*messenger, None);
            }
            self.instance.destroy_instance(None);
        }
    }
}

/// A lens of parallel rays or of rays from the eye, clip space with Vulkan's y downwards. `scales`:
/// of x and y. Reversed depth may reach to infinity.
pub fn lens([x, y]: [f64; 2], parallel: bool, reversed: bool, [near, far]: [f64; 2]) -> DMat4 {
    let deep = far - near;
    let (z, w) = match (parallel, reversed) {
        (true, true) => (1.0 / deep, far / deep),
        (true, false) => (-1.0 / deep, -near / deep),
        (false, true) if far.is_infinite() => (0.0, near),
        (false, true) => (near / deep, near * far / deep),
        (false, false) => (-far / deep, -near * far / deep),
    };
    let [of_z, of_w] = if parallel { [0.0, 1.0] } else { [-1.0, 0.0] };
    DMat4::from_cols(
        DVec4::X * x,
        DVec4::Y * -y,
        DVec4::new(0.0, 0.0, z, of_z),
        DVec4::new(0.0, 0.0, w, of_w),
    )
}

/// Scales of a lens of 40 degrees.
pub fn scales(options: &Options) -> [f64; 2] {
    let focal = 1.0 / 20f64.to_radians().tan();
    let aspect = f64::from(options.width) / f64::from(options.height);
    [focal / aspect, focal]
}

/// A host's matrices, z up in the world. Reversed depth reaches to infinity.
pub fn view_and_projection(eye: DVec3, target: DVec3, options: &Options) -> [DMat4; 2] {
    let far = if options.reversed {
        f64::INFINITY
    } else {
        50.0
    };
    let lens = lens(scales(options), false, options.reversed, [0.1, far]);
    [look(eye, target, DVec3::Z), lens]
}

/// Writes sRGB bytes as the PNG file of a name in a folder, and prints where it is.
pub fn write_png(folder: &str, name: &str, options: &Options, pixels: &[u8]) -> Fallible<()> {
    let picture = revmap_files::Picture {
        width: options.width,
        height: options.height,
        rgba: pixels.as_chunks().0.to_vec(),
    };
    let path = format!("{folder}/{name}.png");
    println!("{path}");
    Ok(picture.write_png(path)?)
}

/// The number of pixels that differ by more than 2 of 255.
pub fn differing(a: &[u8], b: &[u8]) -> usize {
    let pixels = a.chunks(4).zip(b.chunks(4));
    let far = pixels.filter(|(a, b)| a.iter().zip(*b).any(|(a, b)| a.abs_diff(*b) > 2));
    far.count()
}
