//! Messages of the validation layers, kept until they are read.

use crate::error::Result;
use crate::gpu::vk::call::Call;
use ash::{ext::debug_utils, vk};
use std::ffi::{CStr, c_void};
use std::sync::Mutex;

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
