//! Animated PNG.

use super::{Playing, failed};
use revmap::error::Result;
use revmap_files::Picture;

pub fn bytes(playing: Playing, size: (u32, u32), frames: &[Picture]) -> Result<Vec<u8>> {
    let mut bytes = Vec::new();
    encode(playing, size, frames, &mut bytes).map_err(failed)?;
    Ok(bytes)
}

fn encode(
    playing: Playing,
    (width, height): (u32, u32),
    frames: &[Picture],
    bytes: &mut Vec<u8>,
) -> std::result::Result<(), png::EncodingError> {
    let opaque = |p: &[u8; 4]| p[3] == u8::MAX;
    let opaque = frames.iter().all(|f| f.rgba.iter().all(opaque));
    let mut encoder = png::Encoder::new(bytes, width, height);
    encoder.set_color(match opaque {
        true => png::ColorType::Rgb,
        false => png::ColorType::Rgba,
    });
    encoder.set_compression(png::Compression::Balanced);
    encoder.set_animated(frames.len() as u32, playing.loops().into())?;
    encoder.set_frame_delay(1, playing.fps())?;
    let mut writer = encoder.write_header()?;
    for frame in frames {
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
