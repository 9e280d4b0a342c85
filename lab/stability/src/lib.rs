//! The stability catalogue: the ways in which this family of methods breaks, each as a scene swept
//! over its critical parameter.
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
