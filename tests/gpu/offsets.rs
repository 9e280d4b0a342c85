//! Extended, beveled and chamfered solids: surfaces missed or made up by the searches, and the
//! accuracy of normals.

use crate::common::passing::{Count, counts};
use crate::common::prelude::*;
use rayon::prelude::*;
use revmap_reference::{Ray, Reference};
use std::f64::consts::FRAC_PI_4;
use std::fmt::Write as _;

const ROWS: u32 = 512;

/// The widest setting comes first, because maps reach as far as their first scene needs. The list
/// has outward and inward offsets, gentle bevels, a steep bevel on an inset solid, and chamfers,
/// one of them steeper than 45 degrees.
fn settings() -> [(&'static str, Offset); 6] {
    [
        ("e = -0.1, b = 1.6, c = 0.3", offset(-0.1, 1.6, 0.3)),
        ("e = 0.05", offset(0.05, 0.0, 1.0)),
        ("e = -0.02", offset(-0.02, 0.0, 1.0)),
        ("b = 0.1", offset(0.0, 0.1, 1.0)),
        ("e = -0.15, b = 0.5", offset(-0.15, 0.5, 1.0)),
        ("b = 0.9, c = 0.12", offset(0.0, 0.9, 0.12)),
    ]
}

/// The conservative rules, and the papers' rule.
const SOLVERS: [Solver; 3] = [Solver::Live, Solver::Quadric, CIRCLE];

const VIEWS: [f64; 3] = [4.0, 38.0, -30.0];

/// `scene` with the same profile but another offset, seen from another elevation.
fn with(scene: &Scene, offset: Offset, elevation: f64) -> Scene {
    let mut scene = scene.clone();
    scene.camera.eye = eye(elevation, 2.3);
    scene.objects[0].offset = offset;
    scene.objects[0].clip = Clip::Box;
    scene
}

fn searched(solver: Solver, width: u32, height: u32) -> Settings {
    sized(width, height).with(|s| (s.solver, s.map_rows) = (solver, Some(ROWS)))
}

/// Shape, setting, then a count for each of `SOLVERS`, summed over the views.
fn table(width: u32, height: u32) -> Vec<(&'static str, &'static str, [Count; 3])> {
    let solvers = SOLVERS.map(|s| searched(s, width, height));
    let mut rows = Vec::new();
    for (shape, profile) in shapes::all() {
        let plain = scene_of(profile, eye(0.0, 2.3));
        let scenes: Vec<Scene> = settings()
            .iter()
            .flat_map(|(_, offset)| VIEWS.map(|v| with(&plain, *offset, v)))
            .collect();
        let counts = counts(&scenes, solvers.each_ref(), 1.0 / f64::from(ROWS));
        for ((name, _), views) in settings().iter().zip(counts.chunks(VIEWS.len())) {
            let all = [0, 1, 2].map(|s| views.iter().map(|v| v[s]).sum());
            rows.push((shape, *name, all));
        }
    }
    rows
}

/// Conservative steps pass no surface by more than a texel and make up none.
#[test]
fn the_conservative_rule_passes_nothing() {
    let rows = table(64, 48);
    let mut failures = String::new();
    let mut papers = Count::default();
    for (shape, setting, counts) in &rows {
        println!("{shape:7} {setting:27} {counts:?}");
        papers = [papers, counts[2]].into_iter().sum();
        for (solver, count) in SOLVERS.iter().zip(counts).take(2) {
            if count.passed + count.made_up > 0 {
                let solver = solver.name();
                writeln!(failures, "{solver}, {shape}, {setting}: {count:?}").unwrap();
            }
        }
    }
    assert!(failures.is_empty(), "{failures}");
    // The count is not trivially zero: the papers' rule does pass surfaces.
    assert!(papers.passed > 0, "{papers:?}");
}

/// Writes the table of docs/offsets.md: `cargo test --release --test gpu write_the_table --
/// --ignored`.
#[test]
#[ignore = "draws for minutes; writes the documentation's table"]
fn write_the_table() {
    let (width, height) = (240, 180);
    let columns = "missed | ghosts | passed | made up | ".repeat(3);
    let lines = "---:|".repeat(13);
    let mut text = format!("\n| solid | offset | pixels | {columns}\n|---|---|{lines}\n");
    let mut all = [Count::default(); 3];
    let mut row = |shape: &str, setting: &str, counts: [Count; 3]| {
        write!(text, "| {shape} | {setting} | {} |", counts[0].hits).unwrap();
        for c in counts {
            for number in [c.missed, c.ghost, c.passed, c.made_up] {
                write!(text, " {number} |").unwrap();
            }
        }
        text.push('\n');
    };
    for (shape, setting, counts) in table(width, height) {
        row(shape, setting, counts);
        all = [0, 1, 2].map(|s| [all[s], counts[s]].into_iter().sum());
    }
    row("all", "", all);
    text.push('\n');
    let file = concat!(env!("CARGO_MANIFEST_DIR"), "/docs/offsets.md");
    let page = std::fs::read_to_string(file).unwrap();
    let (before, rest) = page.split_once("<!-- table -->\n").unwrap();
    let (_, after) = rest.split_once("<!-- end -->").unwrap();
    let page = format!("{before}<!-- table -->\n{text}<!-- end -->{after}");
    std::fs::write(file, page).unwrap();
}

/// Rms angle in degrees between the normals of frame and truth, and the number of pixels. Counted
/// pixels are those around which the truth's normals turn by less than 8 degrees, two texels away
/// in eight directions (facets of the rounder polygons meet at up to 5.6 degrees).
fn smooth_error(scene: &Scene, frame: &Frame, texel: f64) -> (f64, usize) {
    let solids = Reference::new(scene).unwrap();
    let (width, height) = (frame.width, frame.height);
    let camera = CameraFrame::new(&scene.camera, width, height).unwrap();
    let seen = |x: f64, y: f64| {
        let ray = Ray {
            origin: scene.camera.eye,
            direction: camera.direction(x, y),
        };
        solids.trace(ray).hit
    };
    let pixel = 2.0 * (0.5 * scene.camera.fov_y).to_radians().tan() / f64::from(height);
    let squares: Vec<f64> = (0..frame.pixels())
        .into_par_iter()
        .filter(|&index| frame.hits(index))
        .filter_map(|index| {
            let x = f64::from(index as u32 % width) + 0.5;
            let y = f64::from(index as u32 / width) + 0.5;
            let hit = seen(x, y)?;
            let step = 2.0 * texel / (pixel * hit.t);
            for k in 0..8 {
                let (dy, dx) = (f64::from(k) * FRAC_PI_4).sin_cos();
                let other = seen(x + step * dx, y + step * dy)?;
                if other.normal.dot(hit.normal) < 8f64.to_radians().cos() {
                    return None;
                }
            }
            let drawn = DVec3::from_array(frame.normal[index].map(f64::from));
            let angle = drawn.dot(hit.normal).clamp(-1.0, 1.0).acos().to_degrees();
            Some(angle * angle)
        })
        .collect();
    let (sum, count) = (squares.iter().sum::<f64>(), squares.len());
    ((sum / count.max(1) as f64).sqrt(), count)
}

/// Normals are right within 2 degrees away from creases, for every offset. The error comes from
/// 16-bit floats, whose steps are coarser at large distances.
#[test]
fn normals_follow_bevel_and_chamfer() {
    let mut failures = String::new();
    for map_format in [MapFormat::R32, MapFormat::R16] {
        for (shape, profile) in shapes::all() {
            let plain = scene_of(profile, eye(0.0, 2.3));
            let settings_of = searched(Solver::Live, 96, 72);
            let all = settings();
            let first = with(&plain, all[0].1, 25.0);
            let settings = settings_of.with(|s| s.map_format = map_format);
            let mut renderer = Offscreen::new(device(), &first, &settings).unwrap();
            for (name, offset) in all {
                let scene = with(&plain, offset, 25.0);
                let frame = updated(&mut renderer, &scene);
                let (rms, count) = smooth_error(&scene, &frame, 1.0 / f64::from(ROWS));
                let what = format!(
                    "{map_format:?} {shape:7} {name:27} {rms:6.3} degrees rms over {count} pixels"
                );
                println!("{what}");
                // An inset of more than half their thickness reduces the discs to a thin spindle.
                let enough = count >= 20 || (shape, name) == ("discs", "e = -0.02");
                if rms > 2.0 || !enough {
                    writeln!(failures, "{what}").unwrap();
                }
            }
        }
    }
    device().check().unwrap();
    assert!(failures.is_empty(), "{failures}");
}
