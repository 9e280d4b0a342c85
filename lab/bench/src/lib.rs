//! Benchmarks of what [`revmap`] draws: a plan, its measurement, tables and charts of what came out.
//!
//! Every time stands beside the error of the picture that was drawn in it: a search that is fast
//! because it misses the surface is seen to be so. See [`measure`](measure::measure) for how times
//! are taken, `stats` for what their intervals mean.
//!
//! | module | content |
//! |---|---|
//! | [`method`] | what is measured: a search, a mesh, or the floor |
//! | [`renderer`] | one renderer for every method |
//! | [`floor`] | frames without a search: what is left of a frame's time |
//! | [`plan`], [`view`] | what a benchmark measures, of what it draws |
//! | [`measure`], [`flight`], [`row`] | measuring, and one measured line |
//! | [`ratios`], [`exhibit`], [`compare_runs`] | what lines say beside each other |
//! | [`plan_file`] | a plan as TOML: what is measured, and what is shown of it |
//! | [`columns`], [`table`], [`chart`], [`page`], [`report`] | tables, charts, one HTML page |
//! | [`folder`], `drawn`, [`submission`] | files of a run; what it drew; one file of a machine's figures |

pub mod chart;
pub mod columns;
pub mod compare_runs;
mod device;
mod drawn;
pub mod exhibit;
pub mod flight;
pub mod floor;
pub mod folder;
mod framing;
pub mod glossary;
mod growth;
pub mod machine;
pub mod measure;
pub mod method;
pub mod names;
pub mod page;
pub mod pictures;
mod places;
pub mod plan;
pub mod plan_file;
mod published;
pub mod ratios;
pub mod renderer;
pub mod report;
pub mod row;
pub mod series_style;
mod stats;
pub mod submission;
mod surroundings;
pub mod table;
pub mod view;

pub use device::DeviceBench;
