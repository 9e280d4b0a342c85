//! What it costs to make contour, patches and tables anew, and to cast rays: `cargo bench --bench
//! surface`.
#![allow(missing_docs, clippy::unwrap_used, clippy::panic)]

#[path = "../tests/common/shapes.rs"]
#[allow(dead_code)]
mod shapes;

use divan::{Bencher, black_box};
use glam::DVec3;
use revmap::cast::RayCaster;
use revmap::profile::{Outline, Profile};
use revmap::scene::{Object, Offset};
use revmap::surface::{
    Contour, ContourSource, FitOptions, ProxyHull, ProxyHullOptions, QuadricPatch, ROWS, Tables,
    fit_patches,
};
use revmap_files::ProfileAxis;

fn main() {
    divan::main();
}

const NAMES: [&str; 6] = ["vase", "discs", "glass", "pawn", "bishop", "king"];

fn outline(name: &str) -> Outline {
    let profile = match name {
        "vase" => shapes::vase(),
        "discs" => shapes::discs(),
        "glass" => shapes::glass(),
        _ => {
            let file = format!("{}/assets/profiles/{name}.svg", env!("CARGO_MANIFEST_DIR"));
            revmap_files::profile(file, ProfileAxis::Center).unwrap()
        }
    };
    profile.outline
}

const OFFSETS: [(&str, Offset); 3] = [
    ("plain", shapes::offset(0.0, 0.0, 1.0)),
    ("extended", shapes::offset(0.02, 0.0, 1.0)),
    ("chamfered", shapes::offset(-0.01, 0.1, 0.5)),
];

fn cases() -> Vec<(&'static str, &'static str)> {
    NAMES
        .iter()
        .flat_map(|&n| OFFSETS.iter().map(move |o| (n, o.0)))
        .collect()
}

fn offset(name: &str) -> Offset {
    OFFSETS.iter().find(|o| o.0 == name).unwrap().1
}

/// A solid's contour under an offset.
fn contour_of(name: &str, technique: &str) -> Contour {
    let source = ContourSource::new(&outline(name)).unwrap();
    source.contour(&offset(technique)).unwrap()
}

/// A bare solid's patches.
fn patches_of(name: &str) -> Vec<QuadricPatch> {
    fit_patches(&contour_of(name, "plain"), &FitOptions::default())
}

/// What depends on the outline alone.
#[divan::bench(args = NAMES)]
fn prepare(bencher: Bencher, name: &str) {
    let outline = outline(name);
    bencher.bench(|| ContourSource::new(black_box(&outline)).unwrap());
}

/// What a slider moves: all of it. The goal is a millisecond for 64 to 128 rows; shaders draw with
/// 256.
#[divan::bench(args = cases(), consts = [64, 128, ROWS])]
fn rebuild<const N: u32>(bencher: Bencher, (name, technique): (&str, &str)) {
    let source = ContourSource::new(&outline(name)).unwrap();
    let offset = offset(technique);
    bencher.bench(|| {
        let contour = source.contour(black_box(&offset)).unwrap();
        let patches = fit_patches(&contour, &FitOptions::default());
        Tables::new(&patches, N)
    });
}

#[divan::bench(args = cases())]
fn contour(bencher: Bencher, (name, technique): (&str, &str)) {
    let source = ContourSource::new(&outline(name)).unwrap();
    let offset = offset(technique);
    bencher.bench(|| source.contour(black_box(&offset)).unwrap());
}

#[divan::bench(args = cases())]
fn patches(bencher: Bencher, (name, technique): (&str, &str)) {
    let contour = contour_of(name, technique);
    bencher.bench(|| fit_patches(black_box(&contour), &FitOptions::default()));
}

/// Dealing out to rows.
#[divan::bench(args = [64, 128, ROWS])]
fn rows(bencher: Bencher, rows: u32) {
    let patches = patches_of("king");
    bencher.bench(|| Tables::new(black_box(&patches), rows));
}

/// The shells of all cells.
#[divan::bench(args = NAMES)]
fn hull(bencher: Bencher, name: &str) {
    let patches = patches_of(name);
    bencher.bench(|| ProxyHull::new(black_box(&patches), &ProxyHullOptions::default()));
}

/// The outline of a picture of 512 rows, anti-aliased.
#[divan::bench]
fn picture(bencher: Bencher) {
    let raster = revmap_files::raster::rasterize(&outline("king"), 128, 512).unwrap();
    bencher.bench(|| revmap_files::trace(black_box(&raster).clone()));
}

/// One ray of the CPU's caster.
#[divan::bench]
fn ray(bencher: Bencher) {
    let profile = Profile::new(outline("king"), 0.5);
    let caster = RayCaster::new(&Object::new("king", profile.into())).unwrap();
    let mut k = 0u32;
    bencher.bench_local(|| {
        k += 1;
        let aim = DVec3::new(0.1, 0.05, (f64::from(k) * 0.618).fract());
        let origin = DVec3::new(2.0, (f64::from(k) * 0.7548).fract() - 0.5, 1.0);
        caster.cast(origin, aim - origin)
    });
}
