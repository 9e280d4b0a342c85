//! Animated WebP, by libwebp.

use super::{Playing, failed};
use revmap::error::Result;
use revmap_files::Picture;
use webp_animation::{AnimParams, EncoderOptions, EncodingConfig, EncodingType};

/// Most pixels on a side.
pub const MAX_SIDE: u32 = 16383;
/// Effort of the search for small files without loss, 0 to 100: more takes long and gives little.
const EFFORT: f32 = 50.0;

pub fn bytes(playing: Playing, size: (u32, u32), frames: &[Picture]) -> Result<Vec<u8>> {
    let config = match playing.quality.unwrap_or(90) {
        100 => EncodingConfig {
            encoding_type: EncodingType::Lossless,
            quality: EFFORT,
            ..EncodingConfig::default()
        },
        quality => EncodingConfig::new_lossy(quality.into()),
    };
    let options = EncoderOptions {
        anim_params: AnimParams {
            loop_count: playing.loops().into(),
        },
        encoding_config: Some(config),
        ..EncoderOptions::default()
    };
    let fail = |e: webp_animation::Error| failed(format!("{e:?}"));
    let mut encoder = webp_animation::Encoder::new_with_options(size, options).map_err(fail)?;
    let at = |n: usize| i32::try_from(playing.start(n, 1000)).map_err(failed);
    for (n, frame) in frames.iter().enumerate() {
        let samples = frame.rgba.as_flattened();
        encoder.add_frame(samples, at(n)?).map_err(fail)?;
    }
    let data = encoder.finalize(at(frames.len())?).map_err(fail)?;
    Ok(data.to_vec())
}
