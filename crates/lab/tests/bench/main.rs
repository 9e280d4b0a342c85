//! The benchmark with a stand-in for the device.
#![allow(clippy::unwrap_used, clippy::panic)]

mod benchmark;
mod planted_faults;
mod stand_in;
