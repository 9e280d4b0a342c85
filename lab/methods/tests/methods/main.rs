//! The mesh baseline and the floor on a device, under the validation layers.
#![allow(clippy::unwrap_used, clippy::panic)]

#[cfg(feature = "shaderc")]
mod fetched_cells;
#[cfg(feature = "shaderc")]
mod floor;
mod mesh;
mod mesh_shading;
#[path = "../../../../tests/common/scenes.rs"]
mod scenes;
#[path = "../../../../tests/common/shapes.rs"]
#[allow(dead_code)]
mod shapes;
