//! PNG and JPEG as profiles, colour maps and displacement maps; PNG and EXR as shape maps and frames.
#![no_main]

use revmap::maps::SlopeFilter;
use revmap_files::{ProfileAxis, profile_from_bytes};

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| {
    let _ = profile_from_bytes(bytes, ProfileAxis::Center);
    let file = tempfile::NamedTempFile::new().unwrap();
    std::fs::write(&file, bytes).unwrap();
    let _ = revmap_files::color_map(&file);
    let _ = revmap_files::displacement_map(&file, SlopeFilter::default());
    let _ = revmap_files::shape_map(&file);
    let _ = revmap_files::read_exr(&file);
});
