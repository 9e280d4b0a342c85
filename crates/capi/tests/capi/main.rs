//! The C interface: its header, its programs in C and C++, wrong arguments, growth.
#![allow(unsafe_code, missing_docs)]
#![allow(clippy::unwrap_used, clippy::panic)] // a test may stop at what it did not expect
#![allow(unused_unsafe)] // some functions that `ok!` and its like call are safe

use names::*;
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
    ($($call:expr;)*) => {$(
        // SAFETY: pointers are live or null, handles are numbers; Vulkan's handles are a host's, which
        // outlives them, and its commands are recorded and waited for in order.
        let result = unsafe { $call };
        crate::succeeds(stringify!($call), result);
    )*};
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
    ($($result:ident, $part:literal: $call:expr;)*) => {$(
        // SAFETY: as in `ok!`; sizes and numbers may be wrong.
        let result = unsafe { $call };
        crate::fails(stringify!($call), result, RevmapResult::$result, $part);
    )*};
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

/// The profile of most of these tests: its points, its radius and a handle of it.
const POINTS: [[f64; 2]; 5] = [[0.0, 0.0], [0.35, 0.2], [0.1, 0.5], [0.35, 0.8], [0.0, 1.0]];
const RADIUS: f64 = 0.4;
fn spindle() -> *mut RevmapProfile {
    let mut profile = null_mut();
    ok! { revmap_profile_from_points(POINTS.as_ptr(), POINTS.len(), RADIUS, &mut profile); }
    profile
}

/// A device of the library's own, validated.
fn device() -> *mut RevmapDevice {
    let mut device = null_mut();
    ok! { revmap_device_open(null(), 1, &mut device); }
    device
}

/// An object of a profile.
fn object_of(profile: *mut RevmapProfile) -> RevmapObjectInfo {
    let mut info = defaults!(revmap_object_defaults, RevmapObjectInfo);
    info.profile = profile;
    info
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
