//! Vulkan in small pieces: calls and their errors, commands and barriers, the one table of
//! descriptors, pipelines.

pub(crate) mod call;
pub(crate) mod clock;
pub(crate) mod commands;
#[cfg(feature = "other-shaders")]
pub mod compiler;
pub(crate) mod descriptors;
pub(crate) mod pipelines;
pub(crate) mod render_pass;
pub(crate) mod sampler;
pub(crate) mod usage;
