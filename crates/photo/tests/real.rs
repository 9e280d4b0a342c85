//! Photographs that a camera took, of `assets/photos`.
#![allow(clippy::unwrap_used)]

use revmap_photo::{Doubt, End, Photo, Reading, is_drawing, read};

fn reading(name: &str) -> Reading {
    let root = concat!(env!("CARGO_MANIFEST_DIR"), "/../../assets/photos/");
    let picture = image::open(format!("{root}{name}")).unwrap().to_rgba8();
    let photo = Photo {
        width: picture.width(),
        height: picture.height(),
        rgba: picture.as_chunks().0,
    };
    assert!(!is_drawing(&photo));
    read(&photo).unwrap()
}

/// Its axis is at column 322.5 of 640, and its tip near row 130 of 427. It is 17 pixels wide, and 25
/// with the cables beside it.
#[test]
fn a_rocket_at_dusk_is_read_between_its_towers() {
    let rocket = reading("rocket.jpg");
    assert!((rocket.axis - 0.5).abs() < 0.01, "{rocket}");
    assert!(
        (rocket.top - (1.0 - 130.0 / 427.0)).abs() < 0.02,
        "{}",
        rocket.top
    );
    let at = |row: f64| {
        let from_top = rocket.top - (1.0 - row / 427.0);
        let part = from_top / (rocket.top - rocket.bottom);
        427.0 * rocket.radii[(part * rocket.radii.len() as f64) as usize]
    };
    for row in [200.0, 250.0, 300.0] {
        assert!((8.0..13.0).contains(&at(row)), "{} in row {row}", at(row));
    }
    // The pad that it stands on is cut.
    assert_eq!(rocket.doubts, [Doubt::Cut(End::Lower)]);
}

/// No outline from 50 degrees above is that of the cup.
#[test]
fn a_cup_from_above_is_doubted() {
    assert_ne!(reading("coffee.jpg").doubts, []);
}
