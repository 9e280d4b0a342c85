//! SVG drawings as profiles, plain or compressed, in every encoding.
#![no_main]

use revmap_files::{ProfileAxis, profile_from_bytes};

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| {
    let _ = profile_from_bytes(bytes, ProfileAxis::Center);
    let _ = profile_from_bytes(bytes, ProfileAxis::Left);
});
