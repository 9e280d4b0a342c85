//! What tests share that need no device.

#[cfg(feature = "drawing")]
pub mod rays;
pub mod samples;
pub mod shapes;
