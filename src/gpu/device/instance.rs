//! The Vulkan loader and an instance, with or without validation, and the messages of the validation
//! layers.

use crate::error::{Error, ErrorKind, Result};
use crate::gpu::device::loader_variables::{hidden_drivers, hidden_layers};
use crate::gpu::vk::call::{Call, kind_of};
use ash::ext::debug_utils;
use ash::{ext, khr, vk};
use std::env::consts::OS;
use std::ffi::{CStr, c_void};
use std::sync::Mutex;

const VALIDATION: &CStr = c"VK_LAYER_KHRONOS_validation";

/// The lowest version whose core holds everything that is used.
pub(crate) const API_VERSION: u32 = vk::API_VERSION_1_2;

/// The environment variable that switches the validation layers on.
pub const VALIDATION_VARIABLE: &str = "REVMAP_VALIDATION";

pub(crate) struct Instance {
    pub raw: ash::Instance,
    /// The messenger that keeps every warning and error; `None` without validation.
    messenger: Option<(debug_utils::Instance, vk::DebugUtilsMessengerEXT)>,
    // Boxed: the driver holds its address.
    messages: Box<Messages>,
    // Keeps the loader's library open.
    entry: ash::Entry,
}

/// What to install where Vulkan is missing, as the end of a message.
pub(crate) struct Packages {
    pub driver: &'static str,
    pub layers: &'static str,
}

/// The packages of a system, by its name in [`OS`].
pub(crate) fn packages(system: &str) -> Packages {
    let (driver, layers) = match system {
        "windows" => (
            "install the graphics card's driver, which brings Vulkan's loader",
            "install the Vulkan SDK",
        ),
        "macos" => (
            "install MoltenVK and Vulkan's loader; the Vulkan SDK has both",
            "install the Vulkan SDK",
        ),
        _ => (
            "install libvulkan1 and a driver such as mesa-vulkan-drivers",
            "install vulkan-validationlayers",
        ),
    };
    Packages { driver, layers }
}

type Messages = Mutex<Vec<String>>;

impl Instance {
    /// Loads Vulkan. `validate` turns on the layers' core and synchronization checks. Missing
    /// layers are then an error.
    pub fn new(validate: bool) -> Result<Self> {
        // SAFETY: the loader is the system's; nothing else in this process replaces it meanwhile.
        let entry = unsafe { ash::Entry::load() }.map_err(|e| {
            let message = format!("no Vulkan loader ({e}); {}", packages(OS).driver);
            Error::new(ErrorKind::Unsupported, message)
        })?;
        // SAFETY: plain query.
        let offered = unsafe { entry.enumerate_instance_extension_properties(None) }
            .map_err(|code| no_driver("vkEnumerateInstanceExtensionProperties", code))?;
        let (mut layers, mut extensions) = (Vec::new(), Vec::new());
        let mut flags = vk::InstanceCreateFlags::empty();
        if is_among(&offered, khr::portability_enumeration::NAME) {
            extensions.push(khr::portability_enumeration::NAME.as_ptr());
            flags |= vk::InstanceCreateFlags::ENUMERATE_PORTABILITY_KHR;
        }
        if validate {
            require_layer(&entry)?;
            layers.push(VALIDATION.as_ptr());
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
        let raw = unsafe { entry.create_instance(&info, None) }
            .map_err(|code| no_driver("vkCreateInstance", code))?;
        let mut made = Self {
            raw,
            messenger: None,
            messages: Box::default(),
            entry,
        };
        if validate {
            made.listen()?;
        }
        Ok(made)
    }

    fn listen(&mut self) -> Result<()> {
        use vk::{
            DebugUtilsMessageSeverityFlagsEXT as Severity, DebugUtilsMessageTypeFlagsEXT as Kind,
        };
        let functions = debug_utils::Instance::new(&self.entry, &self.raw);
        let info = vk::DebugUtilsMessengerCreateInfoEXT::default()
            .message_severity(Severity::WARNING | Severity::ERROR)
            .message_type(Kind::GENERAL | Kind::VALIDATION | Kind::PERFORMANCE)
            .pfn_user_callback(Some(keep))
            .user_data((&raw const *self.messages).cast_mut().cast::<c_void>());
        // SAFETY: the messages outlive the messenger, which Drop destroys first.
        let messenger = unsafe { functions.create_debug_utils_messenger(&info, None) }
            .call("vkCreateDebugUtilsMessengerEXT")?;
        self.messenger = Some((functions, messenger));
        Ok(())
    }

    pub fn validated(&self) -> bool {
        self.messenger.is_some()
    }

    pub fn take_messages(&self) -> Vec<String> {
        let all = self.messages.lock();
        all.map(|mut all| std::mem::take(&mut *all))
            .unwrap_or_default()
    }

    /// An instance with the validation that the environment variable sets.
    pub fn from_environment() -> Result<Self> {
        Self::new(std::env::var_os(VALIDATION_VARIABLE).is_some_and(|v| v != "0" && !v.is_empty()))
    }
}

impl Drop for Instance {
    fn drop(&mut self) {
        // SAFETY: the owner destroyed the device before, and no other thread makes Vulkan calls.
        unsafe {
            if let Some((functions, messenger)) = self.messenger.take() {
                functions.destroy_debug_utils_messenger(messenger, None);
            }
            self.raw.destroy_instance(None);
        }
    }
}

/// The error of a call that failed for want of a driver. The loader also fails with the code of a full
/// memory if a file that it reads is damaged.
pub(crate) fn no_driver(call: &str, code: vk::Result) -> Error {
    let what = format!("no Vulkan driver answered ({call}: {code:?})");
    let memory = "free memory of the host, or mend the damaged .json file of a driver or layer";
    let (kind, remedy) = match (hidden_drivers(), code) {
        (Some(variable), _) => (ErrorKind::Unsupported, variable),
        (_, vk::Result::ERROR_OUT_OF_HOST_MEMORY) => (kind_of(code), memory.to_owned()),
        _ => (kind_of(code), packages(OS).driver.to_owned()),
    };
    Error::new(kind, format!("{what}; {remedy}"))
}

pub(crate) fn is_among(offered: &[vk::ExtensionProperties], extension: &CStr) -> bool {
    let is = |e: &vk::ExtensionProperties| e.extension_name_as_c_str() == Ok(extension);
    offered.iter().any(is)
}

fn require_layer(entry: &ash::Entry) -> Result<()> {
    // SAFETY: plain query.
    let layers = unsafe { entry.enumerate_instance_layer_properties() }
        .map_err(|code| no_driver("vkEnumerateInstanceLayerProperties", code))?;
    let is = |layer: &vk::LayerProperties| layer.layer_name_as_c_str() == Ok(VALIDATION);
    if layers.iter().any(is) {
        return Ok(());
    }
    let remedy = hidden_layers().unwrap_or_else(|| packages(OS).layers.to_owned());
    let message = format!(
        "{VALIDATION_VARIABLE} is set but the layer VK_LAYER_KHRONOS_validation is not found; {remedy}"
    );
    Err(Error::new(ErrorKind::Unsupported, message))
}

/// # Safety
/// Only the driver may call this, with the data that `listen` registered.
unsafe extern "system" fn keep(
    _severity: vk::DebugUtilsMessageSeverityFlagsEXT,
    _kind: vk::DebugUtilsMessageTypeFlagsEXT,
    data: *const vk::DebugUtilsMessengerCallbackDataEXT<'_>,
    user: *mut c_void,
) -> vk::Bool32 {
    // SAFETY: both pointers are valid for the call: `data` by the specification, `user` by `listen`.
    let (data, messages) = unsafe { (data.as_ref(), user.cast::<Messages>().as_ref()) };
    if let (Some(data), Some(messages)) = (data, messages)
        && !data.p_message.is_null()
    {
        // SAFETY: a non-null message is a NUL-terminated string.
        let text = unsafe { CStr::from_ptr(data.p_message) };
        if let Ok(mut all) = messages.lock() {
            all.push(text.to_string_lossy().into_owned());
        }
    }
    vk::FALSE
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Debian's packages help on Linux alone.
    #[test]
    fn each_system_is_told_its_own_packages() {
        for (system, driver, layers) in [
            ("linux", "mesa-vulkan-drivers", "vulkan-validationlayers"),
            ("windows", "graphics card", "Vulkan SDK"),
            ("macos", "MoltenVK", "Vulkan SDK"),
        ] {
            let told = packages(system);
            assert!(told.driver.contains(driver), "{}", told.driver);
            assert!(told.layers.contains(layers), "{}", told.layers);
        }
    }
}
