//! Runs with little memory: exit code 1, one line, no file.

use crate::run::{Bench, CAMERA, SVG};
use std::fmt::Write;

/// Wants a command refused at each of these limits, MiB.
#[track_caller]
fn refused_at(bench: &Bench, limits: &[u32], arguments: &str) {
    for &mib in limits {
        println!("{mib} MiB: {arguments}");
        let limit = format!("ulimit -v {} && exec \"$0\" \"$@\"", mib << 10);
        let mut command = bench.launched(&["sh", "-c", &limit], arguments);
        // Threads fail in other words: "give more memory, or allow more threads".
        bench.refused_by(&mut command, 1, &["memory"]);
    }
}

#[test]
fn large_maps_and_pictures() {
    let bench = Bench::new();
    bench.file("rod.svg", SVG);
    let bake = "bake rod.svg --map-rows 16384";
    refused_at(&bench, &[250, 600, 1000], &format!("{bake} -o m.exr"));
    let binary = format!("{bake} -o m.png --map-source binary");
    refused_at(&bench, &[250, 800], &binary);
    let shade = |x, y| if x < 6000 && y > 300 { 0 } else { 255 };
    bench.grey("big.png", 16_384, 16_384, shade);
    let big = "bake big.png -o m.png --map-rows 64";
    refused_at(&bench, &[250, 500, 1200], big);
    let render = "render scene.toml -o out.png --stage reference --size 16x12";
    for key in ["color_map", "height_map"] {
        let polygon = "polygon = [[0, 0], [0.3, 0.5], [0, 1]]";
        bench.object(&format!("{polygon}\n{key} = \"big.png\""));
        refused_at(&bench, &[250, 500, 1200], render);
    }
}

#[test]
fn a_million_copies() {
    let bench = Bench::new();
    let mut rows = String::new();
    for n in 0..1_000_000 {
        writeln!(rows, "{},{},0,0,0,0,1,0.01,0.01,0.01", n % 1000, n / 1000).unwrap();
    }
    bench.file("copies.csv", rows);
    let object = "[[object]]\npolygon = [[0, 0], [0.3, 0.5], [0, 1]]\ninstances = \"copies.csv\"\n";
    bench.file("scene.toml", format!("{CAMERA}{object}"));
    let render = "render scene.toml -o out.png --stage reference --size 16x12";
    refused_at(&bench, &[150, 200, 250], render);
}
