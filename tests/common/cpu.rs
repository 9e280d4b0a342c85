//! Common code of tests that need no device.

pub mod change;
pub mod outlines;
mod random;
#[allow(dead_code)]
pub mod rays;
pub mod samples;
#[allow(dead_code)] // some are for real profiles, which are drawings
pub mod shapes;
