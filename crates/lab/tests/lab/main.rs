//! The benchmark with a stand-in for the device, and the mesh baseline on a real one.
#![allow(clippy::unwrap_used, clippy::panic)]

#[cfg(feature = "report")]
mod benchmark;
#[cfg(feature = "shaderc")]
mod fetched_cells;
#[cfg(feature = "shaderc")]
mod floor;
#[cfg(feature = "mesh")]
mod mesh;
#[cfg(feature = "mesh")]
mod mesh_shading;
#[cfg(feature = "report")]
mod on_device;
#[cfg(feature = "report")]
mod planted_faults;
#[cfg(feature = "mesh")]
#[path = "../../../../tests/common/scenes.rs"]
mod scenes;
#[cfg(feature = "mesh")]
#[path = "../../../../tests/common/shapes.rs"]
#[allow(dead_code)]
mod shapes;
#[cfg(feature = "report")]
mod stability;
#[cfg(feature = "report")]
mod stand_in;
