//! The Vulkan loader and an instance, with or without validation, and the messages of the validation
//! layers.

use crate::error::{Error, ErrorKind, Result};
use crate::gpu::vk::call::{Call, kind_of};
use ash::ext::debug_utils;
use ash::{ext, khr, vk};
use std::ffi::{CStr, c_void};
use std::sync::Mutex;

const VALIDATION: &CStr = c"VK_LAYER_KHRONOS_validation";

/// The lowest version whose core holds everything that is used.
pub(crate) const API_VERSION: u32 = vk::API_VERSION_1_2;

/// The environment variable that switches the validation layers on.
pub const VALIDATION_VARIABLE: &str = "REVMAP_VALIDATION";

pub(crate) struct Instance {
    pub messages: Option<Messages>,
    pub raw: ash::Instance,
    // Keeps the loader's library open.
    _entry: ash::Entry,
}

impl Instance {
    /// Loads Vulkan. `validate` turns on the layers' core and synchronization checks. Missing
    /// layers are then an error.
    pub fn new(validate: bool) -> Result<Self> {
        // SAFETY: the loader is the system's; nothing else in this process replaces it meanwhile.
        let entry = unsafe { ash::Entry::load() }.map_err(|e| {
            Error::new(
                ErrorKind::Unsupported,
                format!("no Vulkan loader ({e}); install libvulkan1 and a driver such as mesa-vulkan-drivers"),
            )
        })?;
        let layers = if validate {
            require_layer(&entry)?;
            vec![VALIDATION.as_ptr()]
        } else {
            Vec::new()
        };
        // SAFETY: plain query.
        let offered = unsafe { entry.enumerate_instance_extension_properties(None) }
            .call("vkEnumerateInstanceExtensionProperties")?;
        let portability = offered.iter().any(|e| {
            e.extension_name_as_c_str()
                .is_ok_and(|name| name == khr::portability_enumeration::NAME)
        });
        let mut extensions = Vec::new();
        let mut flags = vk::InstanceCreateFlags::empty();
        if portability {
            extensions.push(khr::portability_enumeration::NAME.as_ptr());
            flags |= vk::InstanceCreateFlags::ENUMERATE_PORTABILITY_KHR;
        }
        if validate {
            extensions.push(ext::debug_utils::NAME.as_ptr());
            extensions.push(ext::validation_features::NAME.as_ptr());
        }
        let checks = [vk::ValidationFeatureEnableEXT::SYNCHRONIZATION_VALIDATION];
        let mut features =
            vk::ValidationFeaturesEXT::default().enabled_validation_features(&checks);
        let application = vk::ApplicationInfo::default()
            .application_name(c"revmap")
            .engine_name(c"revmap")
            .api_version(API_VERSION);
        let mut info = vk::InstanceCreateInfo::default()
            .application_info(&application)
            .flags(flags)
            .enabled_layer_names(&layers)
            .enabled_extension_names(&extensions);
        if validate {
            info = info.push_next(&mut features);
        }
        // SAFETY: `info` and all it points to live until the call returns.
        let raw = unsafe { entry.create_instance(&info, None) }.map_err(|code| {
            Error::new(
                kind_of(code),
                format!("no Vulkan driver answered (vkCreateInstance: {code:?}); install one, e.g. mesa-vulkan-drivers"),
            )
        })?;
        let messages = if validate {
            match Messages::new(&entry, &raw) {
                Ok(messages) => Some(messages),
                Err(error) => {
                    // SAFETY: nothing was made of the instance yet.
                    unsafe { raw.destroy_instance(None) };
                    return Err(error);
                }
            }
        } else {
            None
        };
        Ok(Self {
            messages,
            raw,
            _entry: entry,
        })
    }

    /// An instance with the validation that the environment variable sets.
    pub fn from_environment() -> Result<Self> {
        Self::new(std::env::var_os(VALIDATION_VARIABLE).is_some_and(|v| v != "0" && !v.is_empty()))
    }
}

impl Drop for Instance {
    fn drop(&mut self) {
        self.messages = None;
        // SAFETY: the owner destroyed the device before.
        unsafe { self.raw.destroy_instance(None) };
    }
}

fn require_layer(entry: &ash::Entry) -> Result<()> {
    // SAFETY: plain query.
    let layers = unsafe { entry.enumerate_instance_layer_properties() }
        .call("vkEnumerateInstanceLayerProperties")?;
    let there = layers.iter().any(|layer| {
        layer
            .layer_name_as_c_str()
            .is_ok_and(|name| name == VALIDATION)
    });
    if there {
        return Ok(());
    }
    Err(Error::new(
        ErrorKind::Unsupported,
        format!(
            "{VALIDATION_VARIABLE} is set but the layer VK_LAYER_KHRONOS_validation is not installed; install vulkan-validationlayers"
        ),
    ))
}

type Store = Mutex<Vec<String>>;

/// A messenger that keeps every warning and error.
pub(crate) struct Messages {
    functions: debug_utils::Instance,
    messenger: vk::DebugUtilsMessengerEXT,
    // Boxed: the driver holds its address.
    store: Box<Store>,
}

impl Messages {
    pub fn new(entry: &ash::Entry, instance: &ash::Instance) -> Result<Self> {
        let store = Box::<Store>::default();
        let functions = debug_utils::Instance::new(entry, instance);
        let info = vk::DebugUtilsMessengerCreateInfoEXT::default()
            .message_severity(
                vk::DebugUtilsMessageSeverityFlagsEXT::WARNING
                    | vk::DebugUtilsMessageSeverityFlagsEXT::ERROR,
            )
            .message_type(
                vk::DebugUtilsMessageTypeFlagsEXT::GENERAL
                    | vk::DebugUtilsMessageTypeFlagsEXT::VALIDATION
                    | vk::DebugUtilsMessageTypeFlagsEXT::PERFORMANCE,
            )
            .pfn_user_callback(Some(keep))
            .user_data((&raw const *store).cast_mut().cast::<c_void>());
        // SAFETY: the store outlives the messenger, which Drop destroys first.
        let messenger = unsafe { functions.create_debug_utils_messenger(&info, None) }
            .call("vkCreateDebugUtilsMessengerEXT")?;
        Ok(Self {
            functions,
            messenger,
            store,
        })
    }

    /// Takes all messages since the last call.
    pub fn take(&self) -> Vec<String> {
        self.store
            .lock()
            .map(|mut all| std::mem::take(&mut *all))
            .unwrap_or_default()
    }
}

impl Drop for Messages {
    fn drop(&mut self) {
        // SAFETY: the owner drops this before the instance, and no other thread makes Vulkan calls
        // then.
        unsafe {
            self.functions
                .destroy_debug_utils_messenger(self.messenger, None);
        }
    }
}

/// # Safety
/// Only the driver may call this, with the data that `new` registered.
unsafe extern "system" fn keep(
    _severity: vk::DebugUtilsMessageSeverityFlagsEXT,
    _kind: vk::DebugUtilsMessageTypeFlagsEXT,
    data: *const vk::DebugUtilsMessengerCallbackDataEXT<'_>,
    user: *mut c_void,
) -> vk::Bool32 {
    // SAFETY: both pointers are valid for the call: `data` by the specification, `user` by `new`.
    let (data, store) = unsafe { (data.as_ref(), user.cast::<Store>().as_ref()) };
    if let (Some(data), Some(store)) = (data, store)
        && !data.p_message.is_null()
    {
        // SAFETY: a non-null message is a NUL-terminated string.
        let text = unsafe { CStr::from_ptr(data.p_message) };
        if let Ok(mut all) = store.lock() {
            all.push(text.to_string_lossy().into_owned());
        }
    }
    vk::FALSE
}
