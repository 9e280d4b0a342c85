//! SVG drawings, plain or compressed, in every encoding.
#![no_main]

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| drop(revmap_drawing::read(bytes)));
