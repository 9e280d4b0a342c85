//! The folder of a run: `results.csv`, `raw.csv`, `left-out.csv`, `machine.txt`, and whatever pictures and pages belong to it.

use super::chart::Figure;
use super::chart::raster::raster;
use super::chart::svg::svg;
use super::csv::Table;
use super::machine::Machine;
use super::measure::Measured;
use super::names;
use super::pictures::png;
use super::plan::Plan;
use super::row::{CLOCKS_APART, COLUMNS, Clocks, Row};
use revmap::error::{Error, Result, Stage};
use revmap::frame::atomic_file::write_atomically;
use std::io::Write;
use std::path::{Path, PathBuf};

/// Makes a folder that does not exist yet: `base/name`, else `base/name-2` and so on. Results are never overwritten.
///
/// # Errors
/// [`Stage::Report`] when it cannot be made.
pub fn fresh(base: &Path, name: &str) -> Result<PathBuf> {
    let mut folder = base.join(name);
    let mut count = 1;
    while folder.exists() {
        count += 1;
        folder = base.join(format!("{name}-{count}"));
    }
    make(&folder)?;
    Ok(folder)
}

/// Makes a folder and those above it.
///
/// # Errors
/// [`Stage::Report`] when it cannot be made.
pub fn make(folder: &Path) -> Result<()> {
    std::fs::create_dir_all(folder).map_err(|e| {
        Error::new(
            Stage::Report,
            format!("cannot be made ({e}); choose another folder with --out"),
        )
        .in_file(folder)
    })
}

/// Writes a text file, whole or not at all.
///
/// # Errors
/// [`Stage::Report`], naming the file.
pub fn write_text(file: &Path, text: &str) -> Result<()> {
    write_bytes(file, text.as_bytes())
}

/// Writes a file, whole or not at all.
///
/// # Errors
/// [`Stage::Report`], naming the file.
pub fn write_bytes(file: &Path, bytes: &[u8]) -> Result<()> {
    write_atomically(Stage::Report, file, |writer| {
        writer.write_all(bytes).map_err(|e| {
            Error::new(
                Stage::Report,
                format!("cannot be written ({e}); free some space"),
            )
        })
    })
}

/// Writes a figure as SVG and as PNG of twice its size into `folder/charts`.
///
/// # Errors
/// When a file cannot be written.
pub(crate) fn keep_figure(folder: &Path, name: &str, figure: &Figure) -> Result<()> {
    let charts = folder.join("charts");
    make(&charts)?;
    write_text(&charts.join(format!("{name}.svg")), &svg(figure))?;
    write_bytes(
        &charts.join(format!("{name}.png")),
        &png(&raster(figure, 2.0)?)?,
    )
}

/// `results.csv`: one record a row, with the columns of [`COLUMNS`].
#[must_use]
pub fn results(rows: &[Row], machine: &Machine) -> Table {
    let mut table = Table::new(&COLUMNS);
    table.records = rows
        .iter()
        .map(|row| row.record(&machine.device, &machine.driver))
        .collect();
    table
}

/// `raw.csv`: every sample. `row` counts the records of `results.csv` from 1; passes and rounds count from 1.
#[must_use]
pub fn raw(rows: &[Row]) -> Table {
    let mut table = Table::new(&[
        "row", "scene", "stage", "solver", "pass", "round", "gpu_ms", "frame_ms",
    ]);
    for (number, row) in rows.iter().enumerate() {
        for (pass, samples) in row.passes.iter().enumerate() {
            for (round, sample) in samples.iter().enumerate() {
                table.records.push(vec![
                    (number + 1).to_string(),
                    row.scene.clone(),
                    names::stage(row.settings.stage).into(),
                    row.settings.method.to_string(),
                    (pass + 1).to_string(),
                    (round + 1).to_string(),
                    sample
                        .gpu_ms
                        .map(|ms| names::number(ms, 7))
                        .unwrap_or_default(),
                    names::number(sample.frame_ms, 7),
                ]);
            }
        }
    }
    table
}

/// What is in no summary and why: rows whose clocks disagree (`row` is their number in `results.csv`), and measurements that could not
/// be made (`row` is empty).
#[must_use]
pub fn left_out(plan: &Plan, measured: &Measured) -> Table {
    let mut table = Table::new(&["row", "scene", "stage", "solver", "reason"]);
    for (number, row) in measured.rows.iter().enumerate() {
        if let Clocks::Disagree { gpu_ms, frame_ms } = row.clocks() {
            table.records.push(vec![
                (number + 1).to_string(),
                row.scene.clone(),
                names::stage(row.settings.stage).into(),
                row.settings.method.to_string(),
                format!(
                    "the device's clock says {} ms, the wall clock {} ms: more than {:.0} % apart",
                    names::number(gpu_ms, 4),
                    names::number(frame_ms, 4),
                    100.0 * CLOCKS_APART
                ),
            ]);
        }
    }
    for (case, reason) in &measured.left_out {
        table.records.push(vec![
            String::new(),
            plan.views
                .get(case.view)
                .map(|v| v.name.clone())
                .unwrap_or_default(),
            names::stage(case.settings.stage).into(),
            case.settings.method.to_string(),
            reason.clone(),
        ]);
    }
    table
}

/// Writes `results.csv` and `raw.csv`.
///
/// # Errors
/// [`Stage::Report`], naming the file.
pub fn write_rows(folder: &Path, rows: &[Row], machine: &Machine) -> Result<()> {
    write_text(&folder.join("results.csv"), &results(rows, machine).text())?;
    write_text(&folder.join("raw.csv"), &raw(rows).text())
}

/// Writes the four files that every run has.
///
/// # Errors
/// [`Stage::Report`], naming the file.
pub fn write(folder: &Path, plan: &Plan, measured: &Measured, machine: &Machine) -> Result<()> {
    make(folder)?;
    write_rows(folder, &measured.rows, machine)?;
    write_text(
        &folder.join("left-out.csv"),
        &left_out(plan, measured).text(),
    )?;
    let note: String = machine
        .lines()
        .iter()
        .map(|(what, which)| format!("{what}: {which}\n"))
        .collect();
    write_text(&folder.join("machine.txt"), &note)
}
