//! Profiles from pictures: dark is solid.

mod fair;
mod photo;
mod thin_lines;
mod transparency;

pub(crate) use photo::outline_over;

use super::seeming::{Silhouette, is_shell};
use super::{KINDS, ProfileOptions, ProfileRead, options};
use crate::content_fault;
use crate::faults::{full_fault, half_empty_fault};
use crate::maps::header::Header;
use crate::pixels::decode;
use crate::trace::{trace, trace_split};
use rayon::prelude::*;
use revmap::error::Result;
use revmap::host_memory;
use revmap::profile::{Profile, Raster};
use revmap_drawing::luminance;

/// What needs memory, in messages.
const PICTURE: &str = "the pixels of a picture";

/// A profile from the bytes of a PNG or JPEG.
///
/// The picture is laid over white in its own (sRGB) values. A pixel's coverage is its darkness, and
/// everything darker than one half is solid. Width and height are read and checked before anything
/// is decoded.
///
/// The papers' RGBA texture, if this crate wrote it, is read as a shape map: its channel A is the
/// form, its axis the left edge.
pub(super) fn profile(bytes: &[u8], options: &ProfileOptions) -> Result<Profile> {
    if let Some(header) = Header::of_png(bytes).filter(|h| h.kind() == Some("shape")) {
        return baked(bytes, &header);
    }
    options.for_picture()?;
    let picture = decode(bytes, KINDS)?;
    let (width, height) = (picture.width, picture.height);
    if width < 2 || height < 2 {
        return Err(content_fault(format!(
            "the image has {width} x {height} pixels, too few for a shape; give at least 2 x 2"
        )));
    }
    if options.read == ProfileRead::Auto
        && let Some(found) = photo::profile(&picture, options)?
    {
        return Ok(found);
    }
    // Darkness over white; with `invert`, lightness over black.
    let dark = picture.map(|[r, g, b, alpha]| {
        let grey = luminance([r, g, b]);
        alpha * if options.invert { grey } else { 1.0 - grey }
    })?;
    // What hints need; the picture is dropped before the next large list.
    let contrast = options::contrast(&dark, width as usize, options);
    let solid = dark.iter().map(|&d| d > options.edge());
    let solid = host_memory::collected(solid, PICTURE)?;
    let opaque = picture.map(|[.., alpha]| alpha > 0.5)?;
    drop(picture);
    // The axis is an edge of columns, or it splits the first column that is used.
    let halves = (2.0 * options.axis.fraction() * f64::from(width)).round() as u32;
    let halves = halves.min(2 * width - 2);
    let (first, split) = (halves / 2, !halves.is_multiple_of(2));
    let columns = width - first;
    let mut half = host_memory::reserved(columns as usize * height as usize, PICTURE)?;
    for row in dark.chunks_exact(width as usize) {
        half.extend_from_slice(&row[first as usize..]);
    }
    drop(dark);
    let half_plane = Raster {
        columns,
        rows: height,
        coverage: half,
    };
    let raster = options.apply(half_plane, split)?;
    if raster.coverage.par_iter().all(|&c| c > 0.5) {
        return Err(full_fault("image"));
    }
    let coverage = host_memory::collected(raster.coverage.iter().copied(), PICTURE)?;
    let traced = Raster { coverage, ..raster };
    let form = Silhouette::of_pixels(&solid, width as usize, 0.5 * f64::from(halves));
    let is_empty = traced.coverage.par_iter().all(|&c| c <= 0.5);
    if let Some(aside) = form.elsewhere(options.axis).filter(|_| is_empty) {
        return Err(half_empty_fault(&aside));
    }
    let mut profile = trace_split(traced, split)?;
    let cut_out = transparency::hint(&solid, &opaque, options.invert);
    let alone = cut_out.clone().filter(|_| !is_shell(&profile.outline));
    if let Some(hint) = alone.or(contrast) {
        profile.warnings.push(hint);
        return Ok(profile);
    }
    let of_form = |half: &_| {
        let marked = thin_lines::warnings(
            &solid,
            width as usize,
            0.5 * f64::from(halves),
            options.axis,
        );
        let mut hints = marked.unwrap_or_else(|| form.hints(half, options.axis, || None));
        hints.extend(cut_out);
        hints
    };
    let reversed = !options.invert && form.is_light_on_dark();
    profile.warnings =
        options::warnings(&raster, split, &profile.outline, options, reversed, of_form);
    Ok(profile)
}

/// The form of a shape map in its file.
fn baked(bytes: &[u8], header: &Header) -> Result<Profile> {
    let picture = decode(bytes, KINDS)?;
    let raster = Raster {
        columns: picture.width,
        rows: picture.height,
        coverage: picture.map(|[.., alpha]| alpha)?,
    };
    Ok(Profile {
        radius: header.number("radius")?,
        ..trace(raster)?
    })
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use crate::ProfileAxis;
    use crate::png_bytes as png;
    use image::{GrayImage, Luma};

    fn raster(bytes: &[u8], axis: ProfileAxis) -> Raster {
        profile(bytes, &axis.into()).unwrap().raster.unwrap()
    }

    #[test]
    fn one_bit_and_palette() {
        // Written byte by byte, since the image crate writes neither.
        for (color, palette) in [
            (png::ColorType::Grayscale, None),
            (
                png::ColorType::Indexed,
                Some(&[10, 20, 10, 250, 255, 255][..]),
            ),
        ] {
            let mut bytes = Vec::new();
            let mut e = png::Encoder::new(&mut bytes, 8, 2);
            e.set_depth(png::BitDepth::One);
            e.set_color(color);
            palette.into_iter().for_each(|p| e.set_palette(p));
            let mut e = e.write_header().unwrap();
            e.write_image_data(&[0x0f, 0xff]).unwrap();
            e.finish().unwrap();
            let r = raster(&bytes, ProfileAxis::Left);
            let solid = (0..16).map(|k| k < 4);
            assert!(r.coverage.iter().map(|&c| c > 0.5).eq(solid));
        }
    }

    #[test]
    fn the_right_half_of_even_and_odd_widths() {
        let even = GrayImage::from_fn(6, 3, |x, _| Luma([(x * 40) as u8]));
        let r = raster(&png(even), ProfileAxis::Center);
        assert_eq!((r.columns, r.rows), (3, 3));
        assert!((r.coverage[0] - (1.0 - 120.0 / 255.0)).abs() < 1e-6);
        // Odd: 5 x 3, the middle column and its neighbours solid in the lower rows.
        let odd = GrayImage::from_fn(5, 3, |x, y| {
            Luma([if y > 0 && (1..4).contains(&x) { 0 } else { 255 }])
        });
        let p = profile(&png(odd), &ProfileAxis::Center.into()).unwrap();
        assert!((p.radius - 5.0 / 6.0).abs() < 1e-15);
        // The solid is one column and a half wide and two rows high.
        assert_eq!(p.raster, None);
        let b = p.outline.bounds().unwrap();
        let found = [b.r_min, b.r_max, b.z_min, b.z_max];
        for (found, wanted) in found.into_iter().zip([0.0, 0.5, 0.0, 2.0 / 3.0]) {
            assert!((found - wanted).abs() < 0.12 / 3.0, "{b:?}");
        }
    }

    #[test]
    fn faults_are_named() {
        for (bytes, words) in [
            (&png(GrayImage::from_pixel(8, 8, Luma([255])))[..], "empty"),
            (&png(GrayImage::from_pixel(8, 8, Luma([0]))), "full"),
            (&png(GrayImage::from_pixel(1, 1, Luma([0]))), "1 x 1"),
        ] {
            let text = profile(bytes, &ProfileAxis::Left.into())
                .unwrap_err()
                .to_string();
            assert!(text.contains(words), "{text}");
        }
    }
}
