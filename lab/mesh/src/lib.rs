//! The mesh baseline: the same solids as triangles, drawn beside the searches for comparison.
//!
//! Data flows one way: contour → rings of a meridian → [`Mesh`] → the meshes of a scene → a drawer
//! that records into an [`Offscreen`](revmap_offscreen::Offscreen)'s pass as a
//! [`Guest`](revmap_offscreen::Guest). Nothing in [`revmap`] knows of it. Pass, depth buffer,
//! timestamps and reading back are the renderer's, so that times compare.
//!
//! Meshes draw plain colours with the renderer's shading, and shadows by shadow maps. They refuse
//! what they do not draw: shadows of more than two lights, replicas, maps of colours and heights, and
//! coordinates along the profile.

mod blocks;
mod cascades;
mod fineness;
mod layer;
mod placed;
mod sight;
mod tessellation;
#[cfg(test)]
mod tests;

pub use fineness::Fineness;
pub use layer::{MeshLayer, MeshPipelines};
pub use placed::check_scene;
pub use tessellation::{Mesh, Vertex};
