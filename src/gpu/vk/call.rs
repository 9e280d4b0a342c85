//! Conversion of Vulkan's and the allocator's results to errors of this crate.

use crate::error::{Error, ErrorKind, Result};
use ash::vk;
use gpu_allocator::AllocationError;

/// Adds the call's name to a failed Vulkan call.
pub(crate) trait Call<T> {
    /// Adds `name`, written as in the specification, e.g. `vkCreateImage`.
    fn call(self, name: &str) -> Result<T>;
}

impl<T> Call<T> for std::result::Result<T, vk::Result> {
    fn call(self, name: &str) -> Result<T> {
        self.map_err(|code| vulkan_error(name, code))
    }
}

/// The error of the failed Vulkan call `name`, for other drawing on the device.
#[must_use]
pub fn vulkan_error(name: &str, code: vk::Result) -> Error {
    let kind = kind_of(code);
    Error::new(kind, format!("{name} failed: {code:?}{}", remedy(kind)))
}

/// The error of a failed allocation of `bytes` for `name`, for other drawing on the device.
#[must_use]
pub fn allocation_error(name: &str, bytes: u64, error: &AllocationError) -> Error {
    let kind = match error {
        AllocationError::OutOfMemory => ErrorKind::OutOfDeviceMemory,
        AllocationError::NoCompatibleMemoryTypeFound => ErrorKind::Unsupported,
        // The allocator gives Vulkan's result only in words.
        AllocationError::FailedToMap(words) | AllocationError::Internal(words) => {
            let says = |code: &vk::Result| {
                words.contains(&format!("{code:?}")) || words.contains(&code.to_string())
            };
            let code = ALLOCATIONS.into_iter().find(says);
            code.map_or(ErrorKind::Other, kind_of)
        }
        _ => ErrorKind::Other,
    };
    let mib = bytes as f64 / f64::from(1u32 << 20);
    let remedy = remedy(kind);
    let message = format!("{name}: {mib:.2} MiB cannot be allocated ({error}){remedy}");
    Error::new(kind, message)
}

/// The results with which `vkAllocateMemory` and `vkMapMemory` fail.
const ALLOCATIONS: [vk::Result; 5] = [
    vk::Result::ERROR_DEVICE_LOST,
    vk::Result::ERROR_OUT_OF_HOST_MEMORY,
    vk::Result::ERROR_OUT_OF_DEVICE_MEMORY,
    vk::Result::ERROR_MEMORY_MAP_FAILED,
    vk::Result::ERROR_TOO_MANY_OBJECTS,
];

pub(in crate::gpu) fn kind_of(code: vk::Result) -> ErrorKind {
    use vk::Result as R;
    match code {
        R::ERROR_DEVICE_LOST => ErrorKind::DeviceLost,
        // A mapping fails if the process has no addresses left.
        R::ERROR_OUT_OF_HOST_MEMORY | R::ERROR_MEMORY_MAP_FAILED => ErrorKind::OutOfHostMemory,
        R::ERROR_OUT_OF_DEVICE_MEMORY
        | R::ERROR_OUT_OF_POOL_MEMORY
        | R::ERROR_FRAGMENTED_POOL
        | R::ERROR_FRAGMENTATION => ErrorKind::OutOfDeviceMemory,
        R::ERROR_TOO_MANY_OBJECTS => ErrorKind::TooLarge,
        R::ERROR_INITIALIZATION_FAILED
        | R::ERROR_INCOMPATIBLE_DRIVER
        | R::ERROR_LAYER_NOT_PRESENT
        | R::ERROR_EXTENSION_NOT_PRESENT
        | R::ERROR_FEATURE_NOT_PRESENT
        | R::ERROR_FORMAT_NOT_SUPPORTED => ErrorKind::Unsupported,
        _ => ErrorKind::Other,
    }
}

fn remedy(kind: ErrorKind) -> &'static str {
    match kind {
        ErrorKind::DeviceLost => "; the device was lost: open it again, and draw less at once",
        ErrorKind::OutOfDeviceMemory | ErrorKind::TooLarge => {
            "; draw a smaller picture, fewer objects or fewer map rows"
        }
        ErrorKind::OutOfHostMemory => "; free memory of the host",
        ErrorKind::Unsupported => {
            "; open another device, update its driver, or allow this process more memory"
        }
        _ => "",
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_failure_of_an_allocation_has_its_kind_and_remedy() {
        use {ErrorKind as K, vk::Result as R};
        for (code, kind, words) in [
            (R::ERROR_DEVICE_LOST, K::DeviceLost, "lost"),
            (R::ERROR_OUT_OF_HOST_MEMORY, K::OutOfHostMemory, "host"),
            (
                R::ERROR_OUT_OF_DEVICE_MEMORY,
                K::OutOfDeviceMemory,
                "smaller",
            ),
            (R::ERROR_TOO_MANY_OBJECTS, K::TooLarge, "fewer"),
        ] {
            // The allocator writes results in these two forms.
            let told = AllocationError::Internal(format!("in vkAllocateMemory: {code:?}"));
            let mapped = AllocationError::FailedToMap(code.to_string());
            let errors = [
                vulkan_error("vkCreateImage", code),
                allocation_error("plane", 5 << 20, &told),
                allocation_error("plane", 5 << 20, &mapped),
            ];
            for error in errors {
                assert_eq!(error.kind, kind, "{error}");
                assert!(error.message.contains(words), "{error}");
            }
        }
        let full = allocation_error("plane", 5 << 20, &AllocationError::OutOfMemory);
        assert_eq!(full.kind, ErrorKind::OutOfDeviceMemory);
        assert!(full.message.starts_with("plane: 5.00 MiB"), "{full}");
        let odd = AllocationError::Internal("a bug".into());
        assert_eq!(allocation_error("plane", 1, &odd).kind, ErrorKind::Other);
    }
}
