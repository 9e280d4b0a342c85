//! Benchmarks of what [`revmap`] draws: a plan, its measurement, tables and charts of what came out.
//!
//! Every time stands beside the error of the picture that was drawn in it: a search that is fast
//! because it misses the surface is seen to be so. See [`measure`](measure::measure) for how times
//! are taken, `stats` for what their intervals mean.
//!
//! | folder | content, each using only those above it |
//! |---|---|
//! | [`method`] | ways of drawing: a search, a mesh or the floor, and one renderer for all |
//! | [`plan`] | what a benchmark measures, of which views |
//! | [`measure`] | measuring: rows, their ratios, the machine, what was drawn |
//! | [`chart`] | charts as SVG, and the look of each way |
//! | [`table`] | tables and their columns |
//! | [`exhibit`] | which tables and charts a report shows, and the sentences above them |
//! | [`report`] | a run's files: plans as TOML, the page, the folder, pictures |
//! | [`compare_runs`] | runs beside each other |
//! | [`submission`] | one file of a machine's figures |

pub mod chart;
pub mod compare_runs;
pub mod exhibit;
pub mod measure;
pub mod method;
pub mod names;
pub mod plan;
#[cfg(test)]
#[path = "../../../tests/common/random.rs"]
mod random;
pub mod report;
mod stats;
pub mod submission;
pub mod table;
