//! Solids of revolution on Vulkan, drawn from a flat outline without a stored mesh.
//!
//! A **profile**, a region of the half-plane `(r, z)`, is turned about the axis `r = 0`. Each
//! pixel's ray `o + t v` is followed in that half-plane, where the ray is the branch of a hyperbola
//!
//! ```text
//! r(t) = sqrt(a t^2 + 2 b t + c),   z(t) = o_z + t v_z,     a = v_x^2 + v_y^2,  b = o_x v_x + o_y v_y,  c = o_x^2 + o_y^2,
//! ```
//!
//! until it meets the surface
//!
//! ```text
//! F(r, z) = d(r, z) - w(z) = 0,     w = e + b min(1 - z, c).
//! ```
//!
//! `d` is the signed distance to the profile's boundary. `e`, `b` and `c` are the extension, bevel
//! and chamfer, which may change from frame to frame. The default search solves the boundary as
//! quadrics of revolution and reads no map. [`Solver::Live`](settings::Solver::Live) steps along a
//! map of `d`.
//!
//! The method, its extensions and its choice of projections are those of
//!
//! * A. Halli, A. Saaidi, K. Satori, H. Tairi: *Extrusion and revolution mapping*. ACM Transactions
//!   on Graphics 29 (5), 2010, 1-14.
//!   [doi:10.1145/1857907.1857908](https://doi.org/10.1145/1857907.1857908)
//! * A. Ragragui, A. Ouazzani Chahdi, A. Halli, K. Satori: *Revolution mapping with bump mapping
//!   support*. Graphical Models 100, 2018, 1-11.
//!   [doi:10.1016/j.gmod.2018.09.001](https://doi.org/10.1016/j.gmod.2018.09.001)
//! * A. Ragragui, A. Ouazzani Chahdi, A. Halli, K. Satori, H. El Moubtahij: *The extensions of
//!   revolution-bump mapping*. Journal of Graphic Engineering and Design 13 (1), 2022, 21-31.
//!   [doi:10.24867/JGED-2022-1-021](https://doi.org/10.24867/JGED-2022-1-021)
//! * A. Ragragui, A. Ouazzani Chahdi, A. Arbah, H. El Moubtahij, A. Halli, K. Satori:
//!   *Revolution-bump mapping with texture function adjustment according to the geometry of the
//!   revolved object*. Journal of Graphic Engineering and Design, 2025.
//!
//! The last two are "the papers" of this documentation. The papers' search is `circle` of the crate
//! `revmap-searches`. The **RBM baseline** (revolution-bump mapping) of reports is this search with
//! 20 steps over the distances of a binary image in 8 bits.
//!
//! # What holds
//!
//! * Both draw stages call one tracer, and no driver may contract its sums and products. Their frames
//!   are equal to the last bit, on an NVIDIA H100 too. The frames of the default search are an
//!   exception, since each stage finds its patches differently.
//! * The default search, [`Solver::Exact`](settings::Solver::Exact), intersects the exact boundary.
//!   Its hits differ from the reference in double precision (the crate `revmap-reference`) by
//!   hundredths of a texel of a map of 512 rows.
//! * The box cuts a solid that extends past it, and the cut is closed. Any camera position is
//!   allowed.
//! * A failure is an [`Error`] that names its kind, key and remedy. The library does not panic. It
//!   reads and writes no file.
//!
//! # A picture
//!
//! ```no_run
//! use glam::DVec3;
//! use revmap::{gpu::Device, profile::Profile, scene::{Camera, Object, Scene}, settings::Settings};
//! use std::sync::Arc;
//!
//! let spindle = Profile::polygon(&[[0.0, 0.0], [0.4, 0.5], [0.0, 1.0]], 0.5)?;
//! let mut scene = Scene::new(Camera::new(DVec3::new(2.0, 0.0, 1.0), DVec3::new(0.0, 0.0, 0.5)));
//! scene.objects.push(Object::new("spindle", Arc::new(spindle)));
//!
//! let device = Device::open(None)?;
//! let drawn = revmap_offscreen::draw(&device, &scene, &Settings::default())?;
//! revmap_files::write_png(&drawn.frame, "spindle.png")?;
//! # Ok::<(), revmap::Error>(())
//! ```
//!
//! # In an engine
//!
//! A [`gpu::Renderer`] holds objects and records them into any command buffer. It works within a
//! host's render pass or dynamic rendering, with the host's matrices and depth buffer, with several
//! frames in flight.
//!
//! ```no_run
//! # use revmap::{gpu::*, scene::*, settings::*};
//! # fn main() -> revmap::Result<()> {
//! # let (instance, physical, device): (ash::Instance, ash::vk::PhysicalDevice, ash::Device) = unimplemented!();
//! # let (queue_family, features, cmd, slot, view, projection, viewport) = unimplemented!();
//! # let (color, depth) = (ash::vk::Format::UNDEFINED, ash::vk::Format::UNDEFINED);
//! # let (pawn, moved): (Object, Offset) = unimplemented!();
//! // SAFETY: the handles belong together and outlive the borrow.
//! let device = unsafe { Device::borrow(&HostDevice {
//!     instance: &instance, physical, device: &device, queue_family, features,
//!     queue: None, allocator: None, pipeline_cache: None,
//! }) }?;
//! let begun = PassKind::Dynamic { color: vec![color], depth, stencil: ash::vk::Format::UNDEFINED };
//! let depth = DepthOrder::Reversed;
//! let output = Output::Pass(PassFormats { depth, ..PassFormats::new(begun, Planes::Color) });
//! let mut renderer = Renderer::new(&device, output, &SearchSettings::default(), 2)?;
//! let pawn = renderer.add(pawn)?;
//! renderer.prewarm()?.compile()?; // from here on no frame compiles a pipeline
//!
//! // In every frame:
//! renderer.set_offset(pawn, moved)?;
//! let view = View::from_matrices(view, projection, viewport, DepthOrder::Reversed)?;
//! // SAFETY: `cmd` is recording, and the frame before in this slot is done.
//! let frame = unsafe { renderer.prepare(cmd, slot, &view)? };
//! // ... begin the pass, draw what is yours ...
//! unsafe { renderer.record(cmd, &frame)? };
//! # Ok(())
//! # }
//! ```
//!
//! `examples/engine` is a complete host of this kind.
//!
//! # A tour
//!
//! Data flows one way, and a module imports from those above it:
//!
//! | module | what it makes of what comes before |
//! |---|---|
//! | [`frame`] | the planes of a picture |
//! | [`profile`] | a polygon or an outline: a region of the half-plane |
//! | `surface` | the boundary under its offset as a few quadrics of revolution, and the tables that are walked |
//! | [`maps`] | signed distances on a grid, in the forms that shaders read; slopes of heights; colours; lengths along the profile |
//! | [`search`] | searches that other crates bring, for comparison |
//! | [`settings`] | *how* it is drawn: stage, search, budget, format of maps |
//! | [`scene`] | camera, lights, objects: *what* is drawn, as plain values |
//! | `shader` | modules of SPIR-V, the blocks that they read, and the variants of pipelines |
//! | [`shading`] | a host's function of shading, with its modules |
//! | `solid` | all that is made from one outline under an offset, without Vulkan |
//! | [`cast`] | rays on the CPU, for picking and physics |
//! | `plan` | what a view draws, as plain data: paths, tiles, steps |
//! | [`gpu`] | a device, opened or borrowed; [`gpu::Renderer`], which records into a host's commands |
//!
//! Modules without a link, and names that this documentation leaves out, are for the crates of the
//! repository. They may change in any version.
//!
//! # Features
//!
//! | feature | brings |
//! |---|---|
//! | `shaderc` | compiles the GLSL at build time and a host's shading at run time, which needs a C++ compiler; else the SPIR-V kept in the repository is embedded |
//! | `other-shaders` | for measurements of other shaders: pipelines of SPIR-V that the host gives, and what drivers make of them |
//!
//! # Other crates
//!
//! `revmap-offscreen` draws a scene without a host and smooths silhouettes, a client of [`gpu`].
//! `revmap-files` reads profiles from SVG drawings and pictures, and scenes from TOML; it writes
//! frames as PNG and EXR. The program is `revmap-cli`. Crates that measure are in `lab`:
//! `revmap-reference` is ground truth, `revmap-compare` compares frames, `revmap-bench` measures.

pub mod cast;
pub mod error;
pub mod frame;
pub mod gpu;
#[doc(hidden)]
pub mod host_memory;
pub mod maps;
mod names;
mod plan;
pub mod profile;
pub mod scene;
pub mod search;
pub mod settings;
mod shader;
pub mod shading;
mod solid;
#[doc(hidden)]
pub mod surface;

/// The document's example is tested with those of the library.
#[cfg(doctest)]
#[doc = include_str!("../docs/embedding.md")]
mod embedding {}

pub use error::{Error, Result};
