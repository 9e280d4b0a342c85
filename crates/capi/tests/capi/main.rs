//! The C interface: its header, its programs in C and C++, wrong arguments, growth.
#![allow(unsafe_code, missing_docs)]
#![allow(clippy::unwrap_used, clippy::panic)] // a test may stop at what it did not expect

use revmap_capi::fault::{RevmapResult, revmap_last_error, revmap_last_error_text};
use std::ffi::CStr;

/// The text of this thread's last failure.
fn text() -> String {
    // SAFETY: it lasts until this thread's next failure.
    let text = unsafe { CStr::from_ptr(revmap_last_error_text()) };
    text.to_string_lossy().into_owned()
}

#[track_caller]
fn succeeds(call: &str, result: RevmapResult) {
    assert_eq!(result, RevmapResult::Ok, "{call}: {}", text());
}

/// Calls that succeed.
macro_rules! ok {
    ($($call:expr;)*) => { $(crate::succeeds(stringify!($call), $call);)* };
}

/// The call has failed so, and its text says this.
#[track_caller]
fn fails(call: &str, result: RevmapResult, wanted: RevmapResult, part: &str) {
    let text = text();
    assert_eq!(result, wanted, "{call}: {text}");
    assert_eq!(revmap_last_error(), wanted, "{call}");
    assert!(
        text.contains(part) && !text.contains('\n'),
        "{call}: {text}"
    );
}

/// Calls that fail: the result of each, a part of its text, the call.
macro_rules! fail {
    ($($result:ident, $part:literal: $call:expr;)*) => {
        $(crate::fails(stringify!($call), $call, crate::RevmapResult::$result, $part);)*
    };
}

/// A structure of the header, of plain numbers and null pointers.
fn zeros<T: Copy>() -> T {
    // SAFETY: all of them are valid as zeros.
    unsafe { std::mem::zeroed() }
}

/// A structure that a function has filled in.
fn filled<T>(mut value: T, fill: unsafe extern "C" fn(*mut T) -> RevmapResult) -> T {
    // SAFETY: a live structure.
    succeeds("defaults", unsafe { fill(&mut value) });
    value
}

/// A structure of zeros that holds its size.
macro_rules! sized {
    ($name:ident) => {
        $name {
            size: size_of::<$name>() as u32,
            ..crate::zeros()
        }
    };
}

/// A structure that a function fills in.
macro_rules! defaults {
    ($function:ident, $name:ident) => {
        crate::filled(sized!($name), $function)
    };
}

/// The names that most of these tests use.
mod names {
    #![allow(unused_imports)] // each file takes what it needs
    pub use ash::vk;
    pub use glam::{DMat4, DVec3, Vec3};
    pub use revmap::{gpu::*, profile::*, scene::*, settings::*};
    pub use revmap_capi::renderer::{frame::*, objects::*, statistics::*, *};
    pub use revmap_capi::{device::*, enums::*, fault::*, object::*, offscreen::*};
    pub use revmap_capi::{profile::*, rays::*, shading::*, texture::*, values::*};
    pub use std::ptr::{null, null_mut};
    pub use std::sync::Arc;
}

mod arguments;
mod header;
#[cfg(unix)]
mod layout;
mod lists;
#[cfg(unix)]
mod pictures;
// Compiles with cc what a script for sh installs and pkg-config finds.
#[cfg(unix)]
mod programs;
mod random;
mod rays;
mod recording;
mod shading;

#[path = "../../../../tests/common/host.rs"]
mod host;
