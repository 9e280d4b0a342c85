//! Benchmarks of what [`revmap`] draws: a plan, its measurement, tables and charts of what came out.
//!
//! Every time stands beside the error of the picture that was drawn in it: a search that is fast
//! because it misses the surface is seen to be so. See [`measure`](measure::measure) for how times
//! are taken, and how sure they are.
//!
//! | folder | content |
//! |---|---|
//! | [`plan`] | what a benchmark measures: ways of drawing, views, plans and their files |
//! | [`measure`] | measuring: rows, their statistics and ratios, the machine, what was drawn |
//! | [`report`] | what a report shows, and the folder of a run; see [`revmap_figures`] |
//! | [`compare`] | runs and machines beside each other |

pub mod compare;
pub mod measure;
pub mod plan;
#[cfg(test)]
#[path = "../../../tests/common/random.rs"]
mod random;
pub mod report;
