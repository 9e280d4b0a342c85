//! The C interface: its header, its programs in C and C++, wrong arguments, growth.
#![allow(unsafe_code, missing_docs)]
#![allow(clippy::unwrap_used, clippy::panic)] // a test may stop at what it did not expect

mod arguments;
mod header;
mod layout;
mod pictures;
mod programs;
mod recording;
mod recording_compute;

#[path = "../../../../tests/common/host.rs"]
mod host;
