//! Profiles from photographs, as [`revmap_photo`] reads them.

use super::fair::fair;
use crate::Picture;
use crate::content_fault;
use crate::pixels::{Pixels, decode};
use crate::profile::{KINDS, ProfileOptions, ProfileRead, Smooth, read};
use glam::DVec2;
use revmap::error::Result;
use revmap::profile::{FillRule, Outline, Profile};
use revmap_photo::{Fault, Photo, Reading};

/// Noise of radii that is fairly measured, rows: less is in steep parts alone, more is form.
const NOISE: [f64; 2] = [0.05, 0.2];
/// Reach of the fairing for the root of the noise, rows.
const REACH: f64 = 14.0;
/// Reach of the fairing for the standard deviation of a Gaussian that halves the same waves.
const GAUSSIAN: f64 = 0.85;

/// The profile of a photograph; `None` for a drawing.
pub(super) fn profile(picture: &Pixels, options: &ProfileOptions) -> Result<Option<Profile>> {
    let rgba = picture.rgba8()?;
    let Some(reading) = reading(picture, &rgba)? else {
        return Ok(None);
    };
    let height = f64::from(picture.height);
    let blur = match options.smooth {
        Smooth::Pixels(pixels) if pixels > 0.0 => Some(pixels / height),
        _ => None,
    };
    let widest = reading.radii.iter().copied().fold(0.0, f64::max);
    let radius = (0.5 * f64::from(picture.width) / height).max(1.02 * widest);
    let mut profile = Profile::new(outline(&reading, blur), radius);
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

/// The outline through the radii, faired by their noise, or as by a Gaussian of this standard
/// deviation (heights of the picture). The top edge of the picture is `z = 1`, the bottom edge
/// `z = 0`.
fn outline(reading: &Reading, blur: Option<f64>) -> Outline {
    let count = reading.radii.len();
    let row = (reading.top - reading.bottom) / count as f64;
    // The median of five rows: where the edge is not found in a row or two, the radius leaps.
    let radii: Vec<f64> = (0..count)
        .map(|k| {
            let reach = 2.min(k).min(count - 1 - k);
            let mut near = reading.radii[k - reach..=k + reach].to_vec();
            near.sort_by(f64::total_cmp);
            near[reach] / row
        })
        .collect();
    let noise = noise(&radii).clamp(NOISE[0], NOISE[1]);
    let reach = blur.map_or(REACH * noise.sqrt(), |blur| GAUSSIAN * blur / row);
    let (first, last) = (radii[0], radii[count - 1]);
    let ends = [DVec2::new(last, 0.0), DVec2::new(first, count as f64)];
    let side = (0..count)
        .rev()
        .map(|k| DVec2::new(radii[k], (count - k) as f64 - 0.5));
    let corners = ends[..1].iter().copied().chain(side);
    let corners = corners.chain([ends[1], DVec2::new(0.0, count as f64)]);
    // Points one row apart along the line, which fairing takes for even ones.
    let mut points = vec![DVec2::ZERO];
    for corner in corners {
        let from = points[points.len() - 1];
        let parts = from.distance(corner).round().max(1.0);
        points.extend((1..=parts as u32).map(|k| from.lerp(corner, f64::from(k) / parts)));
    }
    let place = |p: DVec2| DVec2::new(p.x.max(0.0) * row, reading.bottom + p.y * row);
    let line: Vec<DVec2> = fair(&points, reach, noise).into_iter().map(place).collect();
    Outline::enclosed(&[line], FillRule::NonZero)
}

/// Standard deviation of the noise of values a row apart, across the line through them: from third
/// differences, which curves do not change.
fn noise(radii: &[f64]) -> f64 {
    const APART: usize = 3;
    let mut found: Vec<f64> = radii
        .windows(3 * APART + 1)
        .map(|r| {
            let rise = r[3 * APART] - r[0];
            let third = rise - 3.0 * (r[2 * APART] - r[APART]);
            third.abs() / (rise / (3 * APART) as f64).hypot(1.0)
        })
        .collect();
    found.sort_by(f64::total_cmp);
    // The median of a normal distribution's size is 0.6745 of its standard deviation.
    found
        .get(found.len() / 2)
        .map_or(0.0, |middle| middle / (0.6745 * 20f64.sqrt()))
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
            let (profile, axis) = read(bytes, options)?;
            let outline = profile.outline;
            let (height, width) = (f64::from(pixels.height), f64::from(pixels.width));
            let axis = axis.fraction() * width;
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
    use crate::profile_from_bytes;
    use image::{Rgb, RgbImage};

    fn auto() -> ProfileOptions {
        ProfileOptions {
            read: ProfileRead::Auto,
            ..ProfileOptions::default()
        }
    }

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

    /// A lit vase with a ledge, in grain of 3 grey levels: its height is 300 of 360 pixels.
    fn vase(z: f64) -> f64 {
        match z {
            0.88.. => 52.0,
            _ => 60.0 + 30.0 * (6.0 * z).sin() - 20.0 * z,
        }
    }

    #[test]
    fn a_photograph_has_no_ridges_and_keeps_its_ledge() {
        let grain = |x: u32, y: u32| {
            let mixed = (x * 0x9e37 + y * 0x79b9).wrapping_mul(0x85eb_ca6b);
            f64::from((mixed ^ mixed >> 15).wrapping_mul(0x2c1b_3c6d) >> 16) / 65535.0 - 0.5
        };
        let picture = RgbImage::from_fn(240, 360, |x, y| {
            let z = (330.5 - f64::from(y) - 0.5) / 300.0;
            let reach = if (0.0..1.0).contains(&z) {
                vase(z)
            } else {
                0.0
            };
            let solid = (0.5 + 0.25 * (reach - (f64::from(x) - 119.5).abs())).clamp(0.0, 1.0);
            let lit = 90.0 - 0.5 * (f64::from(x) - 120.0);
            let grey = 220.0 + solid * (lit - 220.0) + 40.0 * grain(x, y);
            Rgb([grey as u8, (0.95 * grey) as u8, (0.9 * grey) as u8])
        });
        let profile = profile_from_bytes(&png_bytes(picture), auto()).unwrap();
        let (mut sum, mut length, mut ledge) = (0.0, 0.0, 0.0f64);
        for segment in profile.outline.surface_segments() {
            let z = |p: glam::DVec2| (360.0 * p.y - 29.5) / 300.0;
            let (a, b) = (segment.a * 360.0, segment.b * 360.0);
            let middle = 0.5 * (z(segment.a) + z(segment.b));
            if (0.05..0.84).contains(&middle) {
                let slope = (vase(middle + 1e-4) - vase(middle - 1e-4)) / 0.06;
                let off = ((b.x - a.x) / (b.y - a.y)).atan() - slope.atan();
                sum += off.to_degrees().powi(2) * (b - a).length();
                length += (b - a).length();
                assert!((a.midpoint(b).x - vase(middle)).abs() < 0.5, "{middle}");
            }
            if (0.86..0.9).contains(&middle) {
                ledge = ledge.max((b - a).normalize().x.abs());
            }
        }
        let slopes = (sum / length).sqrt();
        assert!(slopes < 1.0, "{slopes} degrees");
        assert!(ledge > 0.9, "{ledge}");
    }

    #[test]
    fn a_photograph_becomes_an_outline_in_the_units_of_its_picture() {
        let ball = ball();
        let profile = profile_from_bytes(&ball, auto()).unwrap();
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
        let (count, all) = near(&auto());
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
