//! Tests that draw on a device; every message of the validation layers is a failure.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

#[path = "../common/mod.rs"]
mod common;

mod accuracy;
mod agreement;
mod antialias;
mod bumps;
#[allow(unsafe_code)]
mod calls;
mod clip;
#[allow(unsafe_code)]
mod commands;
mod coplanar;
mod culled;
mod embedding;
mod embedding_bias;
mod embedding_lists;
mod embedding_near;
mod embedding_outputs;
mod embedding_samples;
mod embedding_tools;
mod embedding_visibility;
mod environment;
mod exhausted;
mod fallback;
mod host_images;
#[cfg(feature = "shaderc")] // compiles GLSL at run time
mod host_shading;
#[cfg(feature = "shaderc")]
mod host_shading_faults;
mod hosts;
mod hulls;
mod least_device;
mod limits;
mod memory;
mod memory_types;
mod offsets;
mod pipelines;
mod prewarmed;
mod ranges;
mod refusals;
mod replicas;
mod rounding;
mod shadow_crowds;
mod shadows;
mod small_copies;
mod speckles;
mod spirv;
mod submissions;
mod texturing;
mod tolerance;
mod trouble;
mod unsubmitted;
mod updates;
mod viewports;
mod walks;
