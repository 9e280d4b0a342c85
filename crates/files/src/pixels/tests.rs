#![allow(clippy::unwrap_used)]
use super::*;
use image::{DynamicImage, ImageFormat, Rgb, RgbImage};

fn jpeg_bytes(picture: &DynamicImage) -> Vec<u8> {
    let mut file = Cursor::new(Vec::new());
    picture.write_to(&mut file, ImageFormat::Jpeg).unwrap();
    file.into_inner()
}

/// What the image crate makes of every kind of pixels, ours makes of its file.
#[test]
fn pixels_are_those_of_another_decoder() {
    let rgba = |x, y| image::Rgba([x * 40, y * 60, x * y, x * 30 + 7].map(|v| v as u8));
    let picture = DynamicImage::from(image::RgbaImage::from_fn(7, 5, rgba));
    let kinds = [
        picture.to_luma8().into(),
        picture.to_luma_alpha8().into(),
        picture.to_rgb8().into(),
        picture.clone(),
        picture.to_luma16().into(),
        DynamicImage::from(picture.to_luma_alpha16()),
        picture.to_rgb16().into(),
        picture.to_rgba16().into(),
    ];
    for (number, kind) in kinds.into_iter().enumerate() {
        let ours = decode(&crate::png_bytes(kind.clone()), "PNG").unwrap();
        assert_eq!(
            (ours.width, ours.height, ours.channels),
            (7, 5, number % 4 + 1)
        );
        assert_eq!(
            ours.rgba8().unwrap().as_flattened(),
            kind.to_rgba8().as_raw()
        );
        assert_eq!(
            ours.rgb16().unwrap().as_flattened(),
            kind.to_rgb16().as_raw()
        );
    }
    let rgb = |x, y| Rgb([(x * 7) as u8, (y * 12) as u8, 90]);
    let picture = DynamicImage::from(RgbImage::from_fn(33, 21, rgb));
    for kind in [picture.clone(), picture.to_luma8().into()] {
        let file = jpeg_bytes(&kind);
        let theirs = image::load_from_memory(&file).unwrap().to_rgba8();
        let ours = decode(&file, "JPEG").unwrap();
        assert_eq!(ours.rgba8().unwrap().as_flattened(), theirs.as_raw());
    }
}

#[test]
fn a_jpeg_that_was_cut_off_is_damaged() {
    // 64 x 96 pixels, one form.
    for (name, whole) in [
        (
            "baseline",
            &include_bytes!("../../tests/inputs/baseline.jpg")[..],
        ),
        (
            "progressive",
            include_bytes!("../../tests/inputs/progressive.jpg"),
        ),
        (
            "restarts",
            include_bytes!("../../tests/inputs/restarts.jpg"),
        ),
    ] {
        assert!(decode(whole, "JPEG").is_ok(), "{name}");
        // Data after the end are those of other programs.
        assert!(decode(&[whole, b"more".as_slice()].concat(), "JPEG").is_ok());
        let last = [whole.len() - 2, whole.len() - 1];
        for cut in (3..whole.len()).step_by(7).chain(last) {
            let error = decode(&whole[..cut], "JPEG").unwrap_err().to_string();
            assert!(
                error.contains("the image is damaged"),
                "{name}, {cut}: {error}"
            );
            // A copy that stopped leaves zeros in a file of the full length.
            let mut zeros = whole.to_vec();
            zeros[cut..].fill(0);
            assert!(decode(&zeros, "JPEG").is_err(), "{name}, {cut}");
            // A program that mends files adds the marker of the end. A progressive file that ends
            // between two scans is whole, though coarse.
            let ended = decode(&[&whole[..cut], b"\xff\xd9"].concat(), "JPEG");
            let is_whole = cut + 2 == whole.len() || name == "progressive";
            assert!(is_whole || ended.is_err(), "{name}, {cut}");
        }
    }
}

/// Every orientation that a camera stores, of JPEG and PNG.
#[test]
fn pictures_are_upright() {
    let dark = |x, y| Rgb(if x < 8 && y < 8 { [0; 3] } else { [255; 3] });
    let picture = RgbImage::from_fn(24, 16, dark);
    let plain = DynamicImage::from(picture.clone());
    for value in 1..=8u8 {
        let mut upright = plain.clone();
        upright.apply_orientation(image::metadata::Orientation::from_exif(value).unwrap());
        let upright = upright.to_rgba8();
        let head = b"MM\0*\0\0\0\x08\0\x01\x01\x12\0\x03\0\0\0\x01\0".as_slice();
        let exif = [head, &[value, 0, 0]].concat();
        let file = jpeg_bytes(&plain);
        let length = (exif.len() as u16 + 8).to_be_bytes();
        let segment = [b"\xff\xe1".as_slice(), &length, b"Exif\0\0", &exif].concat();
        for (file, slack) in [
            (png_with_exif(&picture, &exif, false), 0),
            (png_with_exif(&picture, &exif, true), 0),
            ([&file[..2], &segment, &file[2..]].concat(), 59),
        ] {
            let ours = decode(&file, "PNG or JPEG").unwrap();
            assert_eq!((ours.width, ours.height), upright.dimensions());
            let ours = ours.rgba8().unwrap();
            let mut pairs = ours.as_flattened().iter().zip(upright.as_raw());
            assert!(pairs.all(|(a, b)| a.abs_diff(*b) <= slack), "{value}");
        }
    }
}

/// A PNG with EXIF data before its pixels, or after them.
fn png_with_exif(picture: &RgbImage, exif: &[u8], late: bool) -> Vec<u8> {
    let mut out = Vec::new();
    let mut encoder = png::Encoder::new(&mut out, picture.width(), picture.height());
    encoder.set_color(png::ColorType::Rgb);
    let mut writer = encoder.write_header().unwrap();
    for is_late in [false, true] {
        if is_late == late {
            writer.write_chunk(png::chunk::eXIf, exif).unwrap();
        }
        if !is_late {
            writer.write_image_data(picture.as_raw()).unwrap();
        }
    }
    writer.finish().unwrap();
    out
}
