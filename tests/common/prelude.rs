//! The names that most tests of devices use.
#![allow(unused_imports)] // each file takes what it needs

pub use super::change::Change;
pub use super::ways::STAGES;
pub use super::*;
pub use ash::vk;
pub use glam::{DMat4, DQuat, DVec2, DVec3, DVec4, Vec3};
pub use revmap::error::ErrorKind;
pub use revmap::frame::Frame;
pub use revmap::gpu::*;
pub use revmap::maps::*;
pub use revmap::profile::*;
pub use revmap::scene::*;
pub use revmap::settings::*;
pub use revmap_offscreen::{Offscreen, OffscreenOptions};
pub use revmap_searches::CIRCLE;
pub use std::collections::HashSet;
pub use std::sync::Arc;
