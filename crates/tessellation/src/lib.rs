//! Solids of [`revmap`] as triangles within a tolerance, for programs that need a mesh: printers,
//! physics, modelling.
//!
//! ```
//! use revmap::{profile::Profile, scene::Object};
//! use revmap_tessellation::Triangles;
//! use std::sync::Arc;
//!
//! let cone = Profile::polygon(&[[0.0, 0.0], [0.5, 0.0], [0.0, 1.0]], 0.5)?;
//! let cone = Triangles::new(&Object::new("cone", Arc::new(cone)), 1e-3)?;
//! assert_eq!(cone.indices.len() % 3, 0);
//! assert!(cone.vertices.iter().all(|v| v.position[2] <= 1.0));
//! # Ok::<(), revmap::Error>(())
//! ```
//!
//! The contour under its offset is thinned to [`Strand`]s of rings, and these are turned about the
//! axis. `revmap-files` writes [`Triangles`] as files.

mod meridian;
mod parted;
mod pixels;
mod triangles;
mod turned;

pub use meridian::{Ring, Strand, strands_of, strands_within};
pub use pixels::pixel_tolerance;
pub use triangles::{Triangles, Vertex};
pub use turned::{Turned, turned_within};
