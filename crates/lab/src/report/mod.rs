//! Benchmarks: a plan, its measurement, tables and charts of what came out (feature `report`).
//!
//! Every time stands beside the error of the picture that was drawn in it: a search that is fast
//! because it misses the surface is seen to be so. See [`measure`](measure::measure) for how times
//! are taken, `stats` for what their intervals mean.

pub mod chart;
pub mod columns;
pub mod compare_runs;
mod device;
pub mod exhibit;
pub mod flight;
pub mod folder;
mod framing;
pub mod glossary;
mod growth;
pub mod machine;
pub mod measure;
pub(crate) mod names;
pub(crate) mod page;
pub mod pictures;
mod places;
pub mod plan;
mod published;
pub mod ratios;
#[allow(clippy::module_inception)]
pub mod report;
pub mod row;
pub mod series_style;
mod stats;
pub mod submission;
mod surroundings;
pub mod table;
pub mod view;

pub use device::DeviceBench;
