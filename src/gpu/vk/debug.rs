//! Labels of commands and names of handles, which debuggers of frames show (`VK_EXT_debug_utils`).

use crate::gpu::device::Shared;
use ash::{ext, vk};
use std::ffi::{CStr, CString};
use std::sync::OnceLock;

/// The functions that label and name; empty if the host has not enabled them.
#[derive(Default)]
pub(crate) struct DebugLabels(OnceLock<ext::debug_utils::Device>);

impl DebugLabels {
    /// Labels and names from now on.
    pub fn enable(&self, instance: &ash::Instance, device: &ash::Device) {
        let functions = || ext::debug_utils::Device::new(instance, device);
        self.0.get_or_init(functions);
    }

    /// Names a handle.
    pub fn name(&self, handle: impl vk::Handle, name: &str) {
        if let (Some(functions), Ok(name)) = (self.0.get(), CString::new(name)) {
            let info = vk::DebugUtilsObjectNameInfoEXT::default()
                .object_handle(handle)
                .object_name(&name);
            // A name is no reason to fail.
            // SAFETY: the handle is live, and of the device of the functions.
            let _ = unsafe { functions.set_debug_utils_object_name(&info) };
        }
    }
}

impl Shared {
    /// Records `commands` under a label.
    pub(in crate::gpu) fn labelled<T>(
        &self,
        cmd: vk::CommandBuffer,
        label: &CStr,
        commands: impl FnOnce() -> T,
    ) -> T {
        let functions = self.debug_labels.0.get();
        if let Some(functions) = functions {
            let info = vk::DebugUtilsLabelEXT::default().label_name(label);
            // SAFETY: `cmd` is recording, as the callers' callers promised.
            unsafe { functions.cmd_begin_debug_utils_label(cmd, &info) };
        }
        let result = commands();
        if let Some(functions) = functions {
            // SAFETY: as above; the label was begun.
            unsafe { functions.cmd_end_debug_utils_label(cmd) };
        }
        result
    }
}
