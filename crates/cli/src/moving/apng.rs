//! Animated PNG.

use super::{Moving, failed};
use revmap::error::Result;

pub fn bytes(moving: &Moving) -> Result<Vec<u8>> {
    let mut bytes = Vec::new();
    encode(moving, &mut bytes).map_err(failed)?;
    Ok(bytes)
}

fn encode(moving: &Moving, bytes: &mut Vec<u8>) -> std::result::Result<(), png::EncodingError> {
    let opaque = |p: &[u8; 4]| p[3] == u8::MAX;
    let opaque = moving.frames.iter().all(|f| f.rgba.iter().all(opaque));
    let mut encoder = png::Encoder::new(bytes, moving.width, moving.height);
    encoder.set_color(match opaque {
        true => png::ColorType::Rgb,
        false => png::ColorType::Rgba,
    });
    encoder.set_compression(png::Compression::Balanced);
    encoder.set_animated(moving.frames.len() as u32, moving.loops.into())?;
    encoder.set_frame_delay(1, moving.fps)?;
    let mut writer = encoder.write_header()?;
    for frame in moving.frames {
        let kept = if opaque { 3 } else { 4 };
        let samples: Vec<u8> = frame
            .rgba
            .iter()
            .flat_map(|p| &p[..kept])
            .copied()
            .collect();
        writer.write_image_data(&samples)?;
    }
    writer.finish()
}
