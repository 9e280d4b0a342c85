//! The benchmark with a stand-in for the device, and the mesh baseline on a real one.
#![allow(clippy::unwrap_used, clippy::panic)]

mod benchmark;
#[cfg(feature = "shaderc")]
mod fetched_cells;
#[cfg(feature = "shaderc")]
mod floor;
mod mesh;
mod mesh_shading;
mod on_device;
mod planted_faults;
#[path = "../../../../tests/common/scenes.rs"]
mod scenes;
#[path = "../../../../tests/common/shapes.rs"]
#[allow(dead_code)]
mod shapes;
mod stand_in;
