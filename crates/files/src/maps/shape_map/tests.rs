#![allow(clippy::unwrap_used)]
use super::*;
use crate::{BINARY, COVERAGE, ProfileAxis, profile};
use revmap::maps::{BakeOptions, MapSource};
use revmap::profile::Profile;

fn map(source: MapSource) -> ShapeMap {
    let cup = [
        [0.0, 0.1],
        [0.31, 0.1],
        [0.4, 0.9],
        [0.35, 0.9],
        [0.25, 0.2],
        [0.0, 0.2],
    ];
    let profile = Profile::polygon(&cup, 1.0 / 3.0).unwrap();
    bake(&profile, source)
}

fn bake(profile: &Profile, source: MapSource) -> ShapeMap {
    let options = BakeOptions {
        reach: 0.45,
        ..BakeOptions::new(source, 97)
    };
    ShapeMap::bake(profile, &options).unwrap()
}

#[test]
fn exr_comes_back_bit_for_bit() {
    let folder = tempfile::tempdir().unwrap();
    for source in [BINARY, COVERAGE, MapSource::EXACT] {
        let file = folder.path().join("cup.exr");
        let map = map(source);
        write_shape_map(&map, &file).unwrap();
        assert_eq!(shape_map(&file).unwrap(), map);
    }
}

#[test]
fn the_papers_texture_comes_back_within_its_bytes() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("cup.png");
    let map = map(MapSource::EXACT);
    write_shape_map(&map, &file).unwrap();
    let back = shape_map(&file).unwrap();
    assert_eq!(
        (back.radius, back.source, back.bounds),
        (map.radius, map.source, map.bounds)
    );
    assert_eq!(back.form, map.form);
    let step = map.largest_distance() / 254.0;
    for (k, (&was, &is)) in map.distance.iter().zip(&back.distance).enumerate() {
        if map.form[k] {
            assert!(is <= 0.0 && (is - was).abs() < 1.5 / 97.0);
        } else {
            assert!(is <= was && is > was - step);
        }
    }
    // The file read as a profile is the form, in the box of the original map.
    let profile = profile(&file, ProfileAxis::Center).unwrap();
    assert_eq!(profile.radius, map.radius);
    assert_eq!(bake(&profile, BINARY).form, map.form);
}

#[test]
fn a_foreign_texture_is_measured_from_its_form() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("foreign.png");
    let ours = map(BINARY);
    let texels = ours.encode(MapFormat::Rgba8).unwrap().bytes;
    image::RgbaImage::from_raw(ours.columns, ours.rows, texels)
        .unwrap()
        .save(&file)
        .unwrap();
    let back = shape_map(&file).unwrap();
    assert_eq!(back.distance, ours.distance);
    assert_eq!(back.radius, f64::from(ours.columns) / 97.0);
}

#[test]
fn faults_are_named_and_leave_no_file() {
    let folder = tempfile::tempdir().unwrap();
    let text = |r: Result<()>| r.unwrap_err().to_string();
    let map = map(BINARY);
    assert!(text(write_shape_map(&map, folder.path().join("a.bmp"))).contains(".exr"));
    let nowhere = folder.path().join("no").join("a.png");
    assert!(text(write_shape_map(&map, &nowhere)).contains("its folder does not exist"));
    assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 0);
    let load = |name: &str| shape_map(folder.path().join(name)).unwrap_err().to_string();
    assert!(load("missing.png").contains("missing.png: the map cannot be read"));
    image::GrayImage::new(8, 8)
        .save(folder.path().join("grey.png"))
        .unwrap();
    assert!(load("grey.png").contains("no shape map"));
    std::fs::write(
        folder.path().join("bad.exr"),
        b"\x76\x2f\x31\x01 and no more",
    )
    .unwrap();
    assert!(load("bad.exr").contains("bad.exr: "));
    write_shape_map(&map, folder.path().join("cut.png")).unwrap();
    let whole = std::fs::read(folder.path().join("cut.png")).unwrap();
    std::fs::write(folder.path().join("cut.png"), &whole[..whole.len() / 2]).unwrap();
    assert!(load("cut.png").contains("damaged"));
}
