//! GIF: one palette for all frames, by k-means, and Floyd-Steinberg dithering: slow gradients have no
//! bands, and what does not move keeps its colour.

use super::{Playing, failed};
use gif::{Frame, Repeat};
use quantette::color_map::NearestNeighborColorMap;
use quantette::deps::palette::Srgb;
use quantette::dither::FloydSteinberg;
use quantette::{ImageRef, PaletteBuf, PaletteSize, Pipeline, QuantizeMethod};
use rayon::prelude::*;
use revmap::error::Result;
use revmap_files::Picture;

/// Pixels from which the palette is made, spread evenly over all frames.
const SAMPLES: usize = 4_000_000;
/// Colours; one code is left for pixels that are as in the frame before.
const COLORS: u8 = 255;

pub fn bytes(playing: Playing, size: (u32, u32), frames: &[Picture]) -> Result<Vec<u8>> {
    let palette = palette(frames)?;
    let indices = frames.par_iter().map(|f| dithered(f, &palette));
    let indices: Vec<Vec<u8>> = indices.collect::<Result<_>>()?;
    let mut bytes = Vec::new();
    encode(playing, size, (&palette, &indices), &mut bytes).map_err(failed)?;
    Ok(bytes)
}

fn palette(frames: &[Picture]) -> Result<PaletteBuf<Srgb<u8>>> {
    let count: usize = frames.iter().map(|f| f.rgba.len()).sum();
    let pixels = frames.iter().flat_map(|f| &f.rgba);
    // An odd step meets all columns.
    let pixels = pixels.step_by((count / SAMPLES) | 1);
    let pixels: Vec<_> = pixels.map(|&[r, g, b, _]| Srgb::new(r, g, b)).collect();
    let pipeline = Pipeline::new().parallel(true);
    let pipeline = pipeline.palette_size(PaletteSize::from_u8_clamped(COLORS));
    let pipeline = pipeline.quantize_method(QuantizeMethod::kmeans());
    let pipeline = pipeline.input_slice(pixels.as_slice()).map_err(failed)?;
    Ok(pipeline.output_srgb8_palette())
}

/// A frame's codes.
fn dithered(frame: &Picture, palette: &PaletteBuf<Srgb<u8>>) -> Result<Vec<u8>> {
    let colors: Vec<Srgb<f32>> = palette.iter().map(|c| c.into_format()).collect();
    let map = NearestNeighborColorMap::new(PaletteBuf::try_from(colors).map_err(failed)?);
    let pixels = frame.rgba.iter().map(|&[r, g, b, _]| Srgb::new(r, g, b));
    let pixels: Vec<Srgb<f32>> = pixels.map(|c| c.into_format()).collect();
    let image = ImageRef::new(frame.width, frame.height, &pixels).map_err(failed)?;
    // All of an error goes on to the next pixels, or slow gradients would have steps.
    let dither = FloydSteinberg::with_error_diffusion(1.0).unwrap_or_default();
    let image = dither.dither_image_to_indexed(image, map);
    Ok(image.indices().to_vec())
}

fn encode(
    playing: Playing,
    (width, height): (u32, u32),
    (palette, indices): (&[Srgb<u8>], &[Vec<u8>]),
    bytes: &mut Vec<u8>,
) -> std::result::Result<(), gif::EncodingError> {
    let [width, height] = [width, height].map(|n| n as u16); // at most 16384
    let colors: Vec<u8> = palette
        .iter()
        .flat_map(|c| [c.red, c.green, c.blue])
        .collect();
    // The palette is filled up to a power of 2, at least one beyond its colours.
    let same = palette.len() as u8;
    let colors = [colors, vec![0; 3]].concat();
    let mut encoder = gif::Encoder::new(bytes, width, height, &colors)?;
    match playing.loops() {
        0 => encoder.set_repeat(Repeat::Infinite)?,
        1 => {}
        // The format counts how often it plays again.
        loops => encoder.set_repeat(Repeat::Finite(loops - 1))?,
    }
    for (n, codes) in indices.iter().enumerate() {
        let mut frame = Frame {
            delay: (playing.start(n + 1, 100) - playing.start(n, 100)) as u16, // at most 100
            width,
            height,
            ..Frame::default()
        };
        frame.buffer = match n.checked_sub(1) {
            None => codes.into(),
            Some(before) => {
                frame.transparent = Some(same);
                let pairs = codes.iter().zip(&indices[before]);
                pairs.map(|(a, b)| if a == b { same } else { *a }).collect()
            }
        };
        encoder.write_frame(&frame)?;
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    /// A slow gradient of grey beside so many colours that few greys are in the palette.
    #[test]
    fn gradients_have_no_bands() {
        const SIDE: usize = 256;
        let pixel = |k: usize| {
            let (x, y) = (k % SIDE, k / SIDE);
            match y < 64 {
                true => [100 + (x / 8) as u8; 4],
                false => [x as u8, (2 * y) as u8, (x * y / 64) as u8, 255],
            }
        };
        let frame = Picture {
            width: SIDE as u32,
            height: SIDE as u32,
            rgba: (0..SIDE * SIDE).map(pixel).collect(),
        };
        let palette = palette(std::slice::from_ref(&frame)).unwrap();
        assert!(palette.len() > 150);
        // Means of 16 x 16 pixels against those of the gradient.
        let worst = |code: &dyn Fn(usize) -> u8| {
            let blocks = (0..48).map(|b| (b % 16 * 16, b / 16 * 16));
            let off = blocks.map(|(left, top)| {
                let sum = |of: &dyn Fn(usize) -> f64| -> f64 {
                    let block = (0..256).map(|k| (top + k / 16) * SIDE + left + k % 16);
                    block.map(of).sum::<f64>() / 256.0
                };
                let wanted = sum(&|k| f64::from(frame.rgba[k][0]));
                // The gradient is grey: one channel has its bands.
                f64::abs(sum(&|k| f64::from(palette[usize::from(code(k))].red)) - wanted)
            });
            off.fold(0.0, f64::max)
        };
        let codes = dithered(&frame, &palette).unwrap();
        let even = worst(&|k| codes[k]);
        let nearest = |k: usize| {
            let far = |c: &Srgb<u8>| {
                let pairs = [c.red, c.green, c.blue].into_iter().zip(frame.rgba[k]);
                pairs
                    .map(|(a, b)| u32::from(a.abs_diff(b)).pow(2))
                    .sum::<u32>()
            };
            let all = (0..palette.len()).min_by_key(|i| far(&palette[*i]));
            all.unwrap() as u8
        };
        let bands = worst(&nearest);
        assert!(even < 1.5 && bands > 3.0, "{even} {bands}");
    }
}
