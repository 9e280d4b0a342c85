//! Figures of measurements, whatever was measured: statistics, tables, charts and pages.
//!
//! | module | content |
//! |---|---|
//! | [`stats`] | medians, intervals, power laws |
//! | [`names`], [`groups`] | numbers as texts; what has one key |
//! | [`table`] | the table of files, of terminals and of pages |
//! | [`chart`] | charts as figures, and these as SVG |
//! | [`page`] | a page that needs nothing beside itself |
//! | [`files`] | files that are written whole |

pub mod chart;
pub mod files;
pub mod groups;
pub mod names;
pub mod page;
#[cfg(test)]
#[path = "../../../tests/common/random.rs"]
mod random;
pub mod stats;
pub mod table;
