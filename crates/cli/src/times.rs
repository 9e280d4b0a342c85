//! What the frames of a film took.

use revmap::error::Result;
use revmap_offscreen::Times;
use std::path::Path;

/// A frame's times, and what was made for it.
#[derive(Default)]
pub struct Row {
    pub times: Times,
    pub compiled: u64,
    pub rebuilt: u64,
}

/// The times of at least one frame in words, and what was made; `compiled` is the number of
/// pipelines. The first ten frames count only where there are no others.
pub fn told(rows: &[Row], compiled: u64) -> [String; 2] {
    let settled = &rows[rows.len().min(10)..];
    let (measured, after, of_them) = match settled {
        [] => (rows, "", String::new()),
        _ => {
            let late: u64 = settled.iter().map(|r| r.compiled).sum();
            let of_them = format!(", {late} of them after the tenth");
            (settled, " after the tenth", of_them)
        }
    };
    let whole = measured
        .iter()
        .map(|r| r.times.prepare_ms + r.times.frame_ms);
    let mut all: Vec<f64> = whole.collect();
    all.sort_by(f64::total_cmp);
    let (median, most) = (all[all.len() / 2], all[all.len() - 1]);
    let rebuilt: u64 = rows.iter().map(|r| r.rebuilt).sum();
    let part = most / median;
    [
        format!("median {median:.2} ms, slowest{after} {most:.2} ms"),
        format!(
            " ({part:.2} of the median); pipelines compiled: {compiled}{of_them}; surfaces made: {rebuilt}"
        ),
    ]
}

/// Writes a table with a line for each frame.
pub fn write(path: &Path, rows: &[Row]) -> Result<()> {
    let mut text =
        String::from("frame,prepare_ms,gpu_ms,frame_ms,pipelines_compiled,surfaces_rebuilt\n");
    for (n, row) in rows.iter().enumerate() {
        let Times {
            prepare_ms,
            gpu_ms,
            frame_ms,
            ..
        } = row.times;
        let gpu = gpu_ms.map_or_else(String::new, |ms| format!("{ms:.4}"));
        let made = format!("{},{}", row.compiled, row.rebuilt);
        text += &format!("{n},{prepare_ms:.4},{gpu},{frame_ms:.4},{made}\n");
    }
    revmap_files::write_bytes(path, text.as_bytes())
}
