//! From the bytes of a target to a frame.

use super::srgb::linear_from_srgb;
use crate::error::Result;
use crate::frame::Frame;
use crate::settings::{DrawStage, Planes, Settings};
use crate::shader::generated::EXHAUSTED_BIT;

/// `planes` as [`Target::read`](super::target::Target::read) gives them: images, then words.
pub(crate) fn frame(
    settings: &Settings,
    background: [f32; 4],
    planes: &[Vec<u8>],
) -> Result<Frame> {
    let mut frame = Frame::new(settings.width, settings.height, background)?;
    let pixels = frame.color.len();
    match settings.planes {
        Planes::Color => {
            // Compute keeps packed colours behind the depths.
            let skip = if settings.stage == DrawStage::Compute {
                4 * pixels
            } else {
                0
            };
            let bytes = planes.first().map_or(&[][..], |p| &p[skip..]);
            for (color, rgba) in frame.color.iter_mut().zip(bytes.chunks_exact(4)) {
                *color = [
                    linear_from_srgb(rgba[0]),
                    linear_from_srgb(rgba[1]),
                    linear_from_srgb(rgba[2]),
                    f32::from(rgba[3]) / 255.0,
                ];
            }
        }
        Planes::Depth { .. } => {}
        Planes::All => {
            let [color, normal, shading, albedo, words] = planes else {
                return Ok(frame);
            };
            let steps = &words[4 * pixels..];
            for (i, value) in frame.color.iter_mut().enumerate() {
                *value = vec4(color, i);
                let [x, y, z, distance] = vec4(normal, i);
                frame.normal[i] = [x, y, z];
                frame.distance[i] = distance;
                let [x, y, z, u] = vec4(shading, i);
                frame.shading_normal[i] = [x, y, z];
                let [r, g, b, v] = vec4(albedo, i);
                frame.albedo[i] = [r, g, b];
                frame.uv[i] = [u, v];
                let word: u32 = bytemuck::pod_read_unaligned(&steps[4 * i..4 * i + 4]);
                frame.exhausted += usize::from(word & EXHAUSTED_BIT != 0);
                let count = word & !EXHAUSTED_BIT;
                #[allow(clippy::cast_precision_loss)] // look-ups of a pixel stay far below 2^24
                {
                    frame.steps[i] = count as f32;
                }
            }
        }
    }
    Ok(frame)
}

fn vec4(bytes: &[u8], pixel: usize) -> [f32; 4] {
    bytemuck::pod_read_unaligned(&bytes[16 * pixel..16 * pixel + 16])
}
