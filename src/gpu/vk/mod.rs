//! Vulkan in small pieces, over raw handles: calls and their errors, uses and barriers, the one table
//! of descriptors, outputs, pipelines.

pub(crate) mod call;
pub(crate) mod descriptors;
pub(crate) mod output;
pub(crate) mod pipelines;
pub(crate) mod render_pass;
pub(crate) mod usage;
