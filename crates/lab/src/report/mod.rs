//! Benchmarks: a plan, its measurement, tables and charts of what came out (feature `report`).
//!
//! Every time stands beside the error of the picture that was drawn in it: a search that is fast
//! because it misses the surface is seen to be so. See [`measure`](measure::measure) for how times
//! are taken, [`stats`] for what their intervals mean.

pub mod antialiasing;
pub mod budget;
mod chapters;
pub mod chart;
pub mod compare_runs;
pub mod crowds;
pub mod curves;
mod device;
pub mod folder;
pub mod framing;
pub mod glossary;
pub mod machine;
pub mod map_error;
pub mod measure;
pub mod names;
pub mod overview;
pub mod page;
pub mod papers;
pub mod picture_groups;
pub mod pictures;
pub mod plan;
pub mod ratios;
pub mod row;
pub mod scaling;
pub mod series_style;
pub mod stats;
pub mod suite;
pub mod summary;
pub mod sweep;
pub mod table;
pub mod text;
pub mod time_budget;
pub mod view;

pub use device::DeviceBench;
