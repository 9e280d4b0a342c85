//! Prints how far outlines traced from pictures are from the drawings that the pictures show:
//! `cargo run --release --example outline_accuracy [ROWS ...]`

use glam::DVec2;
use revmap::profile::{Outline, Profile};
use revmap_files::ProfileAxis;
use revmap_files::raster::pictured;

fn main() -> Result<(), revmap::Error> {
    let rows: Vec<u32> = std::env::args().skip(1).flat_map(|a| a.parse()).collect();
    let rows = match rows[..] {
        [] => vec![64, 128, 256, 512],
        _ => rows,
    };
    println!(
        "| profile | rows | 8 bits: mean / p99 / max, texels | 1/512 of the height | binary: mean / p99 / max, texels | 1/512 of the height |"
    );
    println!("|---|---|---|---|---|---|");
    for (name, truth) in profiles()? {
        for &rows in &rows {
            let columns = (truth.radius * f64::from(rows)).ceil() as u32;
            let mut line = format!("| {name} | {rows} |");
            for levels in [256, 2] {
                let traced = pictured(&truth, columns, rows, levels)?;
                let errors = errors(&truth.outline, &traced.outline, 0.25 / f64::from(rows));
                for unit in [f64::from(rows), 512.0] {
                    let [mean, p99, max] = errors.map(|e| e * unit);
                    line += &format!(" {mean:.3} / {p99:.3} / {max:.2} |");
                }
            }
            println!("{line}");
        }
    }
    Ok(())
}

/// The drawings of chess pieces, and polygons.
fn profiles() -> Result<Vec<(&'static str, Profile)>, revmap::Error> {
    let mut all = Vec::new();
    for name in ["bishop", "king", "pawn", "rook"] {
        let file = format!("{}/assets/profiles/{name}.svg", env!("CARGO_MANIFEST_DIR"));
        all.push((name, revmap_files::profile(file, ProfileAxis::Center)?));
    }
    let round =
        |k: u32, n: u32| DVec2::from_angle(std::f64::consts::TAU * f64::from(k) / f64::from(n));
    let place = |k| DVec2::new(0.311, 0.507) + 0.123 * round(k, 4000);
    let ring: Vec<_> = (0..4000).map(|k| place(k).to_array()).collect();
    let length = |k| if k % 2 == 0 { 0.303 } else { 0.151 };
    let place = |k| DVec2::new(0.352, 0.503) + length(k) * round(k, 10);
    let star: Vec<_> = (0..10).map(|k| place(k).to_array()).collect();
    let cup = [
        [0.0, 0.0513],
        [0.2507, 0.0513],
        [0.2507, 0.0794],
        [0.0503, 0.1201],
        [0.0403, 0.4507],
        [0.3307, 0.9011],
        [0.3003, 0.9011],
        [0.0403, 0.4907],
        [0.0, 0.4907],
    ];
    all.push(("ring", Profile::polygon(&ring, 0.5)?));
    all.push(("star", Profile::polygon(&star, 0.75)?));
    all.push(("cup", Profile::polygon(&cup, 0.5)?));
    Ok(all)
}

/// Mean, 99th percentile and maximum of the distance between two outlines, object units, over
/// points of both that are `step` apart.
fn errors(a: &Outline, b: &Outline, step: f64) -> [f64; 3] {
    let mut distances: Vec<f64> = [(a, b), (b, a)]
        .into_iter()
        .flat_map(|(from, to)| {
            from.surface_segments().flat_map(move |s| {
                let count = (s.a.distance(s.b) / step).ceil();
                (0..count as u32).filter_map(move |k| {
                    let p = s.a.lerp(s.b, f64::from(k) / count);
                    Some(to.nearest(p)?.distance(p))
                })
            })
        })
        .collect();
    distances.sort_unstable_by(f64::total_cmp);
    let n = distances.len().max(1);
    let found = |q: f64| distances.get((q * (n - 1) as f64) as usize);
    let at = |q: f64| found(q).copied().unwrap_or(f64::NAN);
    [distances.iter().sum::<f64>() / n as f64, at(0.99), at(1.0)]
}
