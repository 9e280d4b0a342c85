//! Profiles from photographs, as [`revmap_photo`] reads them.

use super::{KINDS, ProfileOptions, ProfileRead, Smooth};
use crate::Picture;
use crate::pixels::{Pixels, decode};
use crate::trace::trace;
use crate::{content_fault, profile_from_bytes};
use revmap::error::Result;
use revmap::host_memory;
use revmap::profile::{Profile, Raster};
use revmap_photo::{Fault, Photo, Reading};

/// Rows of the raster that the outline is traced from.
const ROWS: [u32; 2] = [512, 1024];

/// The profile of a photograph; `None` for a drawing.
pub(super) fn profile(picture: &Pixels, options: &ProfileOptions) -> Result<Option<Profile>> {
    let rgba = picture.rgba8()?;
    let Some(reading) = reading(picture, &rgba)? else {
        return Ok(None);
    };
    let mut raster = raster(picture, &reading)?;
    let smooth = match options.smooth == Smooth::default() {
        true => Smooth::Auto,
        false => options.smooth,
    };
    smooth.apply(&mut raster, false)?;
    let mut profile = trace(raster)?;
    profile.notes = vec![reading.to_string()];
    profile.warnings = reading.doubts.iter().map(ToString::to_string).collect();
    Ok(Some(profile))
}

fn reading(picture: &Pixels, rgba: &[[u8; 4]]) -> Result<Option<Reading>> {
    let photo = Photo {
        width: picture.width,
        height: picture.height,
        rgba,
    };
    if revmap_photo::is_drawing(&photo) {
        return Ok(None);
    }
    let refused = |fault: Fault| content_fault(fault.to_string());
    revmap_photo::read(&photo).map(Some).map_err(refused)
}

/// The half profile as coverage. The top edge of the picture is `z = 1`, the bottom edge `z = 0`.
fn raster(picture: &Pixels, reading: &Reading) -> Result<Raster> {
    let rows = picture.height.clamp(ROWS[0], ROWS[1]);
    let height = f64::from(rows);
    let widest = reading.radii.iter().copied().fold(0.0, f64::max);
    let radius = (0.5 * f64::from(picture.width) / f64::from(picture.height)).max(1.02 * widest);
    let columns = (radius * height).ceil() as u32;
    let what = "the pixels of a picture";
    let mut coverage = host_memory::reserved(columns as usize * rows as usize, what)?;
    for row in 0..rows {
        let (low, high) = (
            f64::from(rows - row - 1) / height,
            f64::from(rows - row) / height,
        );
        let part = (high.min(reading.top) - low.max(reading.bottom)).max(0.0) * height;
        let reach =
            reading.radius_at(0.5 * (high.min(reading.top) + low.max(reading.bottom))) * height;
        let pixel = |column: u32| (part * (reach - f64::from(column)).clamp(0.0, 1.0)) as f32;
        coverage.extend((0..columns).map(pixel));
    }
    Ok(Raster {
        columns,
        rows,
        coverage,
    })
}

/// The picture with the outline over it.
pub(crate) fn outline_over(bytes: &[u8], options: &ProfileOptions) -> Result<Picture> {
    let pixels = decode(bytes, KINDS)?;
    let mut rgba = pixels.rgba8()?;
    let found = match options.read {
        ProfileRead::Auto => reading(&pixels, &rgba)?.map(|reading| vec![reading.outline]),
        ProfileRead::Threshold => None,
    };
    let loops = match found {
        Some(loops) => loops,
        None => {
            let outline = profile_from_bytes(bytes, *options)?.outline;
            let (height, width) = (f64::from(pixels.height), f64::from(pixels.width));
            let axis = options.axis.fraction() * width;
            let side = |way: f64| {
                let place =
                    move |p: &glam::DVec2| [axis + way * p.x * height, (1.0 - p.y) * height];
                let loops = outline.loops.iter();
                loops.map(move |l| l.iter().map(place).collect::<Vec<_>>())
            };
            side(1.0).chain(side(-1.0)).collect()
        }
    };
    revmap_photo::draw(&mut rgba, pixels.width, &loops);
    Ok(Picture {
        width: pixels.width,
        height: pixels.height,
        rgba,
    })
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use crate::png_bytes;
    use image::{Rgb, RgbImage};

    /// A lit ball of radius 40 at (62, 58), in a picture of 120 x 160.
    fn ball() -> Vec<u8> {
        png_bytes(RgbImage::from_fn(120, 160, |x, y| {
            let away = (f64::from(x) - 61.5).hypot(f64::from(y) - 57.5);
            match away < 40.0 {
                true => Rgb([230 - x as u8, 215 - x as u8, 190 - x as u8]),
                false => Rgb([60, 80 + (y / 8) as u8, 130]),
            }
        }))
    }

    #[test]
    fn a_photograph_becomes_an_outline_in_the_units_of_its_picture() {
        let options = ProfileOptions {
            read: ProfileRead::Auto,
            ..ProfileOptions::default()
        };
        let ball = ball();
        let profile = profile_from_bytes(&ball, options).unwrap();
        assert_eq!(profile.outline.loops.len(), 1);
        assert!((profile.radius - 0.375).abs() < 2e-3, "{}", profile.radius);
        let middle = glam::DVec2::new(0.0, 1.0 - 58.0 / 160.0);
        for segment in profile.outline.surface_segments() {
            let away = (segment.a - middle).length();
            assert!((away - 0.25).abs() < 0.006, "{away}");
        }
        assert!(profile.notes[0].starts_with("read as a photograph: light"));
        assert_eq!(profile.warnings, [""; 0]);
        // The outline over the picture: along the ball's border, by either way of reading.
        let near = |options: &ProfileOptions| {
            let shown = outline_over(&ball, options).unwrap();
            let red = |i: &usize| shown.rgba[*i] == [255, 0, 64, 255];
            let away = |i: usize| (i as f64 % 120.0 - 61.5).hypot((i / 120) as f64 - 57.5);
            let red: Vec<f64> = (0..shown.rgba.len()).filter(red).map(away).collect();
            let count = red.iter().filter(|r| (*r - 40.0).abs() < 2.5).count();
            (count, red.len())
        };
        let (count, all) = near(&options);
        assert!(count > 200 && count == all, "{count} of {all}");
        let light = ProfileOptions {
            axis: crate::ProfileAxis::At(62.0 / 120.0),
            threshold: 0.39,
            invert: true,
            ..ProfileOptions::default()
        };
        // Its loops close along the axis.
        let (count, all) = near(&light);
        assert!(count > 200 && all < 350, "{count} of {all}");
    }
}
