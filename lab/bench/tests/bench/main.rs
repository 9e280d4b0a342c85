//! The benchmark with a stand-in for the device, and on a real one.
#![allow(clippy::unwrap_used, clippy::panic)]

mod benchmark;
mod on_device;
mod planted_faults;
mod stand_in;
