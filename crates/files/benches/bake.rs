//! How long maps take to bake, on one core: `cargo bench -p revmap-files --bench bake`.

#![allow(clippy::unwrap_used)]

use divan::{Bencher, black_box};
use revmap::maps::{BakeOptions, MapSource, ShapeMap};
use revmap::profile::Profile;
use revmap_files::raster::rasterize;
use revmap_files::{BINARY, ProfileAxis};

fn main() {
    // Figures that can be compared between machines: one thread.
    let one = rayon::ThreadPoolBuilder::new().num_threads(1);
    one.build_global().unwrap();
    divan::main();
}

/// A bottle of many curves: a hundred cubics between which the radius swings.
fn hundred_curves() -> String {
    let mut path = String::from("M100,5");
    let step = 190.0 / 100.0;
    for k in 0..100 {
        let z = 5.0 + step * f64::from(k);
        let r = |z: f64| 150.0 + 30.0 * (z * 0.11).sin() + 12.0 * (z * 0.47).cos();
        let (a, b, c) = (z + step / 3.0, z + 2.0 * step / 3.0, z + step);
        let (ra, rb, rc) = (r(a) + 4.0, r(b) - 4.0, r(c));
        path += &format!(" C{ra:.4},{a:.4} {rb:.4},{b:.4} {rc:.4},{c:.4}");
    }
    path += " L100,195 Z";
    format!(
        r#"<svg xmlns="http://www.w3.org/2000/svg" width="200" height="200"><path d="{path}"/></svg>"#
    )
}

/// The same solid as an image.
fn image(rows: u32) -> Profile {
    let points: Vec<[f64; 2]> = (0..=400)
        .map(|k| f64::from(k) / 400.0)
        .map(|z| {
            let r = 0.6 + 0.2 * (z * 22.0).sin() + 0.1 * (z * 90.0).cos();
            [r, 0.02 + 0.96 * z]
        })
        .chain([[0.0, 0.98], [0.0, 0.02]])
        .collect();
    let polygon = Profile::polygon(&points, 1.0).unwrap();
    revmap_files::trace(rasterize(&polygon.outline, rows, rows).unwrap()).unwrap()
}

#[divan::bench(args = [1024, 4096], sample_count = 10)]
fn binary(bencher: Bencher, rows: u32) {
    let (profile, options) = (image(rows), BakeOptions::new(BINARY, rows));
    bencher.bench(|| ShapeMap::bake(black_box(&profile), &options));
}

/// From the file's bytes to the map.
#[divan::bench(args = [1024, 4096], sample_count = 10)]
fn drawing_exact(bencher: Bencher, rows: u32) {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("curves.svg");
    std::fs::write(&file, hundred_curves()).unwrap();
    bencher.bench(|| {
        let profile = revmap_files::profile(black_box(&file), ProfileAxis::Left).unwrap();
        ShapeMap::bake(&profile, &BakeOptions::new(MapSource::EXACT, rows))
    });
}
