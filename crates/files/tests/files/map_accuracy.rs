//! The three sources of distance, measured on a disc at 512 rows: no worse than stated in
//! `docs/maps.md`.

use revmap::maps::{BakeOptions, MapFormat, MapSource, ShapeMap};
use revmap_compare::map_accuracy::{Disc, MapErrors};
use revmap_files::{BINARY, COVERAGE};

fn errors(source: MapSource, rows: u32) -> MapErrors {
    let e = Disc::default().errors(source, rows).unwrap();
    println!("{rows} rows, {source:?}: {e:?}");
    e
}

#[test]
fn binary_is_what_the_papers_have() {
    let e = errors(BINARY, 512);
    // Distances to pixel centres are never less than the truth by more than rounding, and never
    // more by more than a pixel's diagonal.
    assert!(e.mean > 0.0 && e.mean <= 0.36 && e.rms <= 0.41 && e.max <= 1.0);
    assert!((8.0..=10.1).contains(&e.stored_gradient_rms), "{e:?}");
    assert!(e.stored_gradient_max <= 40.0);
    // Finer images do not help the gradient.
    let fine = errors(BINARY, 1024);
    assert!((fine.stored_gradient_rms - e.stored_gradient_rms).abs() < 1.0);
}

#[test]
fn coverage_is_sub_texel() {
    let e = errors(COVERAGE, 512);
    assert!(e.mean.abs() <= 0.001 && e.rms <= 0.004, "{e:?}");
    assert!(e.max <= 0.03 && e.gradient_rms <= 0.25, "{e:?}");
    assert!(
        e.gradient_max <= 2.5 && e.stored_gradient_rms <= 0.25,
        "{e:?}"
    );
    assert!(e.stored_gradient_max <= 1.5, "{e:?}");
}

#[test]
fn exact_is_exact() {
    let e = errors(MapSource::EXACT, 512);
    // The polygon of 65536 corners is off by 1e-9, 32 bits by 1e-5 texel, and always downwards.
    assert!(e.mean <= 0.0 && e.rms <= 1e-4 && e.max <= 1e-4, "{e:?}");
    // The bilinear derivative turns within a cell of a curved field by half a texel over the
    // radius: 0.15 degrees here.
    assert!(e.gradient_rms <= 0.08 && e.gradient_max <= 0.2, "{e:?}");
    // What half floats leave of it.
    let disc = Disc::default();
    let options = BakeOptions::new(MapSource::EXACT, 512);
    let mut map = ShapeMap::bake(&disc.polygon(1 << 16).unwrap(), &options).unwrap();
    map.distance = map.encode(MapFormat::R16).unwrap().distances();
    let e = disc.measure(&map).unwrap();
    println!("512 rows, exact, r16: {e:?}");
    assert!(
        e.mean.abs() <= 0.03 && e.rms <= 0.04 && e.max <= 0.13,
        "{e:?}"
    );
    assert!(e.gradient_rms <= 0.08 && e.gradient_max <= 0.2, "{e:?}");
}

/// The measure itself must detect errors.
#[test]
fn planted_errors_are_found() {
    let disc = Disc::default();
    let profile = disc.polygon(1 << 12).unwrap();
    let good = ShapeMap::bake(&profile, &BakeOptions::new(MapSource::EXACT, 256)).unwrap();
    let clean = disc.measure(&good).unwrap();
    let mut shifted = good.clone();
    for d in &mut shifted.distance {
        *d += 0.25 / 256.0;
    }
    let e = disc.measure(&shifted).unwrap();
    assert!((e.mean - clean.mean - 0.25).abs() < 1e-4 && (e.rms - 0.25).abs() < 1e-2);
    // A field that leans to the right by s turns gradients by s sin(phi): s / sqrt(2) in the mean
    // square.
    let mut leaning = good.clone();
    let lean = 4f64.to_radians();
    for (k, d) in leaning.distance.iter_mut().enumerate() {
        *d += (lean * ((k % 256) as f64 + 0.5) / 256.0) as f32;
    }
    let e = disc.measure(&leaning).unwrap();
    assert!((e.gradient_rms - 4.0 / 2f64.sqrt()).abs() < 0.1, "{e:?}");
    assert!((e.gradient_max - 4.0).abs() < 0.4, "{e:?}");
}
