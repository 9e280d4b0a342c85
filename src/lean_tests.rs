//! What a build without any feature answers to files that it cannot read, and that it has its
//! shaders all the same.
#![allow(clippy::unwrap_used)]

use crate::maps::ShapeMap;
use crate::profile::{Profile, ProfileAxis};

fn refused(bytes: &[u8], feature: &str) {
    let error = Profile::from_bytes(bytes, ProfileAxis::Center).unwrap_err();
    assert!(error.to_string().contains(feature), "{error}");
}

#[test]
fn what_needs_a_feature_is_refused_by_its_name() {
    refused(b"<svg xmlns='http://www.w3.org/2000/svg'/>", "`drawing`");
    refused(b"\xff\xd8\xff\xe0", "`jpeg`");
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("map.exr");
    std::fs::write(&file, b"v/1\x01").unwrap();
    let error = ShapeMap::load(&file).unwrap_err();
    assert!(error.to_string().contains("`exr`"), "{error}");
}

#[test]
fn pictures_are_png_all_the_same() {
    let bottle = include_bytes!("../assets/profiles/bottle.png");
    let bottle = Profile::from_bytes(bottle, ProfileAxis::Center).unwrap();
    assert!(bottle.outline.bounds().is_some());
}
