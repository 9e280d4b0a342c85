#![allow(clippy::unwrap_used)]
use super::*;
use crate::raster::rasterize;
use crate::{ProfileAxis, ProfileOptions, profile_from_bytes};
use image::codecs::jpeg::JpegEncoder;
use image::{GrayImage, Luma};
use proptest::prelude::*;
use revmap::profile::{Outline, Profile, Segment};

const ROWS: u32 = 256;

/// A vase whose wall is two waves with the given heights and phase.
fn vase(waves: [f64; 2], phase: f64) -> Raster {
    let wall = (0..=1000).map(|k| f64::from(k) / 1000.0).map(|t| {
        let r = 0.22 + waves[0] * (5.0 * t + phase).sin() + waves[1] * (13.0 * t).cos();
        [r, 0.05 + 0.9 * t]
    });
    let points: Vec<[f64; 2]> = wall.chain([[0.0, 0.95], [0.0, 0.05]]).collect();
    let polygon = Profile::polygon(&points, 0.4).unwrap();
    rasterize(&polygon.outline, ROWS * 2 / 5, ROWS).unwrap()
}

/// The picture of a half profile in greys, `shade` applied to each.
fn picture(raster: &Raster, mut shade: impl FnMut(f64) -> f64) -> GrayImage {
    let values = raster.coverage.iter();
    let grey = values.map(|&c| shade(255.0 * (1.0 - f64::from(c))).round() as u8);
    GrayImage::from_vec(raster.columns, raster.rows, grey.collect()).unwrap()
}

/// Adds Gaussian noise with the standard deviation `sigma`, of 255.
fn noisy(raster: &Raster, sigma: f64, seed: u32) -> GrayImage {
    let mut state = seed;
    let mut uniform = move || {
        state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        f64::from(state >> 8) / f64::from(1 << 24)
    };
    // The sum of twelve uniform numbers is nearly Gaussian, with the variance 1.
    picture(raster, |grey| {
        grey + sigma * ((0..12).map(|_| uniform()).sum::<f64>() - 6.0)
    })
}

fn png(picture: &GrayImage) -> Vec<u8> {
    crate::png_bytes(picture.clone())
}

fn jpeg(picture: &GrayImage, quality: u8) -> Vec<u8> {
    let mut out = Vec::new();
    JpegEncoder::new_with_quality(&mut out, quality)
        .encode_image(picture)
        .unwrap();
    out
}

fn read(bytes: &[u8], smooth: Smooth) -> Profile {
    let options = ProfileOptions {
        smooth,
        ..ProfileAxis::Left.into()
    };
    profile_from_bytes(bytes, options).unwrap()
}

fn plain(bytes: &[u8]) -> Profile {
    read(bytes, Smooth::default())
}

/// Error of an outline against the clean one: root mean square of the normals' angles along the
/// wall, degrees; largest distance, texels.
fn errors(found: &Outline, clean: &Outline) -> [f64; 2] {
    let (mut sum, mut length, mut most) = (0.0, 0.0, 0.0f64);
    for s in found.surface_segments() {
        let p = s.a.midpoint(s.b);
        most = most.max(clean.nearest(p).unwrap().distance(p));
        if (0.1..0.9).contains(&p.y) {
            let near = |t: &Segment| t.nearest(p).0.distance_squared(p);
            let segments = clean.surface_segments();
            let wall = segments.min_by(|x, y| near(x).total_cmp(&near(y))).unwrap();
            let weight = s.a.distance(s.b);
            sum += weight * (s.b - s.a).angle_to(wall.b - wall.a).powi(2);
            length += weight;
        }
    }
    [(sum / length).sqrt().to_degrees(), most * f64::from(ROWS)]
}

/// Asserts that a picture is called rough, and that `Auto` divides the error of its normals by at
/// least `factor` with the outline less than half a texel away.
#[track_caller]
fn assert_mended(bytes: &[u8], factor: f64) {
    let clean = plain(&png(&picture(&vase([0.1, 0.03], 0.0), |g| g))).outline;
    let (rough, mended) = (plain(bytes), read(bytes, Smooth::Auto));
    assert!(
        rough.warnings.len() == 1
            && rough.warnings[0].starts_with("the outline is rough (0.0")
            && rough.warnings[0].ends_with("set profile_smooth = \"auto\""),
        "{:?}",
        rough.warnings
    );
    assert!(mended.warnings.is_empty(), "{:?}", mended.warnings);
    let (before, after) = (
        errors(&rough.outline, &clean),
        errors(&mended.outline, &clean),
    );
    println!("degrees, texels: {before:?}, {after:?}");
    assert!(after[0] * factor < before[0], "{before:?} {after:?}");
    assert!(after[1] < 0.5, "{before:?} {after:?}");
}

#[test]
fn jpeg_noise_is_named_and_smoothed() {
    let clean = vase([0.1, 0.03], 0.0);
    assert_mended(&jpeg(&picture(&clean, |g| g), 70), 1.8);
    // Grey on grey: ringing is not cut off at black and white.
    let grey = picture(&clean, |g| 40.0 + g * 175.0 / 255.0);
    assert_mended(&jpeg(&grey, 70), 20.0);
}

#[test]
fn clean_pictures_stay_as_they_are() {
    let raster = vase([0.1, 0.03], 0.0);
    let sharp = picture(&raster, |g| g);
    for clean in [
        sharp.clone(),
        picture(&raster, |g| if g < 127.5 { 0.0 } else { 255.0 }),
        picture(&raster, |g| 40.0 + g * 190.0 / 255.0),
        image::imageops::blur(&sharp, 1.0),
        image::imageops::blur(&sharp, 3.0),
        // An ornament of the solid is not noise.
        GrayImage::from_fn(raster.columns, ROWS, |x, y| {
            let Luma([g]) = *sharp.get_pixel(x, y);
            Luma([if (x + 2 * y) % 12 == 0 { g.max(90) } else { g }])
        }),
    ] {
        let profile = plain(&png(&clean));
        assert_eq!(profile.warnings, [""; 0]);
        assert!(read(&png(&clean), Smooth::Auto) == profile);
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(12))]

    /// Silhouettes of many forms: clean ones are left alone, noisy ones are named and mended.
    #[test]
    fn roughness_depends_on_noise_and_not_on_form(
        waves in [0.0..0.1, 0.0..0.06],
        phase in 0.0..6.0,
        sigma in 6.0..20.0,
        seed: u32,
    ) {
        let raster = vase(waves, phase);
        let bytes = png(&picture(&raster, |g| g));
        let clean = plain(&bytes);
        prop_assert!(clean.warnings.is_empty(), "{:?}", clean.warnings);
        prop_assert!(read(&bytes, Smooth::Auto) == clean);
        let bytes = png(&noisy(&raster, sigma, seed));
        prop_assert_eq!(plain(&bytes).warnings.len(), 1);
        let mended = read(&bytes, Smooth::Auto);
        prop_assert!(mended.warnings.is_empty(), "{:?}", mended.warnings);
        prop_assert!(errors(&mended.outline, &clean.outline)[1] < 1.0);
    }
}
