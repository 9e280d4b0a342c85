//! The C interface of revmap: `include/revmap.h`, which is made from these sources, and
//! `include/revmap.hpp`.
//!
//! A handle in C is a number, never an address. The module `handle` looks it up, and so detects
//! handles that are null, destroyed, of another kind, or in use by another thread. Every function
//! enters through `fault::enter`, which stores the failure for its thread and lets no panic out.
//!
//! Documentation of public items is written for the header: it names the C functions.
#![allow(unsafe_code)] // pointers of the caller; what they must be is said in the header
#![allow(clippy::missing_safety_doc)] // the same
#![allow(unsafe_op_in_unsafe_fn)] // all that entry points use is their callers'

pub mod device;
pub mod enums;
pub mod fault;
mod handle;
pub mod object;
pub mod offscreen;
mod pointers;
pub mod profile;
pub mod rays;
pub mod renderer;
pub mod shading;
mod structures;
pub mod texture;
pub mod values;

use std::ffi::c_char;

/// Number of this interface. The number grows when a function or a field is removed or changes its
/// meaning.
pub const REVMAP_ABI: u32 = 1;

/// Version of the library, such as "0.1.0".
#[unsafe(no_mangle)]
pub extern "C" fn revmap_version() -> *const c_char {
    concat!(env!("CARGO_PKG_VERSION"), "\0").as_ptr().cast()
}

/// REVMAP_ABI of the library, to be compared with that of the header.
#[unsafe(no_mangle)]
pub extern "C" fn revmap_abi() -> u32 {
    REVMAP_ABI
}
