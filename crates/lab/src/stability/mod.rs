//! The stability catalogue: the ways in which this family of methods breaks, each as a scene swept
//! over its critical parameter.
//!
//! | module | content |
//! |---|---|
//! | [`case`] | a case: its scenes as TOML text, what breaks and why, what is known to fail |
//! | [`cases`] | the catalogue, in groups |
//! | [`judge`] | errors of one frame against the double-precision reference, and the limits derived for them |
//! | [`run`] | every case, search and stage, drawn and judged |
//! | [`report`] | the table, `results.csv`, `report.html` |
//! | [`glance`] | a failure as the naked eye sees it: the part of a picture that differs most, enlarged |
//! | [`random`] | random scenes held to the same limits; a failing one is reduced to the smallest that still fails |
//!
//! A case passes when no pixel is wrong beyond its limits ([`judge::Truth::limit`]), no number of the
//! frame is NaN or infinite, no ray runs out of steps, and both stages show one picture.

pub mod case;
pub mod cases;
pub mod glance;
pub mod judge;
pub mod random;
pub mod report;
pub mod run;
