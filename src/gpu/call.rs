//! Vulkan's results as errors of ours, with the call's name.

use crate::error::{Error, Result, Stage};
use ash::vk;

/// Adds the call's name to a failed Vulkan call.
pub(crate) trait Call<T> {
    /// `name` as in the specification, e.g. `vkCreateImage`.
    fn call(self, name: &str) -> Result<T>;
}

impl<T> Call<T> for std::result::Result<T, vk::Result> {
    fn call(self, name: &str) -> Result<T> {
        self.map_err(|code| {
            let remedy = match code {
                vk::Result::ERROR_DEVICE_LOST => "; the device was lost: try fewer pixels or steps",
                vk::Result::ERROR_OUT_OF_DEVICE_MEMORY | vk::Result::ERROR_OUT_OF_HOST_MEMORY => {
                    "; try a smaller size or fewer map rows"
                }
                _ => "",
            };
            Error::new(Stage::Draw, format!("{name} failed: {code:?}{remedy}"))
        })
    }
}
