//! The folder of a run: its tables, the note on the machine, pictures and pages.

use crate::measure::drawn::{self, Drawn};
use crate::measure::machine::Machine;
use crate::measure::row::{CLOCKS_APART, Clocks, Row, SUBMISSION_MS};
use crate::measure::{Measured, TRIES};
use crate::plan::Plan;
use crate::plan::method::MethodSettings;
use crate::report::columns::results_table;
use revmap::error::{Error, ErrorKind, Result};
pub use revmap_figures::files::{keep_figure, make, png, write_bytes, write_text};
use revmap_figures::names;
use revmap_figures::table::Table;
use std::path::{Path, PathBuf};

/// Makes a folder that does not exist yet: `base/name`, else `base/name-2` and so on.
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

/// Files that a run writes at the top of its folder.
const FILES: [&str; 6] = [
    "results.csv",
    "raw.csv",
    "excluded.csv",
    "machine.txt",
    "report.html",
    drawn::FILE,
];
/// Folders that a run writes into its own.
const FOLDERS: [&str; 2] = ["charts", "pictures"];

/// Makes a folder for results. A folder that holds an earlier run is refused, unless `overwrite`:
/// then that run's files are removed. None of the `inputs` may be a file that the run writes.
///
/// # Errors
/// [`ErrorKind::Usage`] for a folder that holds an earlier run or an input; [`ErrorKind::File`]
/// when it cannot be made or cleared.
pub fn claim<'a>(
    folder: &Path,
    overwrite: bool,
    inputs: impl IntoIterator<Item = &'a Path>,
) -> Result<()> {
    let usage = |message: &str| {
        let error = Error::new(ErrorKind::Usage, message);
        error.in_file(folder).at_key("out")
    };
    let written = |file: &Path| {
        let within = folder.canonicalize().ok()?;
        let inside = file.canonicalize().ok()?;
        let inside = inside
            .strip_prefix(within)
            .ok()?
            .to_string_lossy()
            .into_owned();
        let first = inside.split(std::path::MAIN_SEPARATOR).next()?;
        Some(FILES.contains(&inside.as_str()) || FOLDERS.contains(&first))
    };
    if inputs.into_iter().any(|file| written(file) == Some(true)) {
        return Err(usage(
            "holds a file that is read as well; choose another folder",
        ));
    }
    let taken = FILES.iter().any(|name| folder.join(name).exists());
    if taken && !overwrite {
        return Err(usage(
            "holds an earlier run; choose another folder, or give --overwrite to replace that run",
        ));
    }
    make(folder)?;
    if taken {
        clear(folder).map_err(|e| {
            let message = format!("the earlier run cannot be removed ({e}); choose another folder");
            Error::new(ErrorKind::File, message).in_file(folder)
        })?;
    }
    Ok(())
}

/// Removes what an earlier run wrote, and nothing else.
fn clear(folder: &Path) -> std::io::Result<()> {
    let remove = |file: &Path| match std::fs::remove_file(file) {
        Err(e) if e.kind() != std::io::ErrorKind::NotFound => Err(e),
        _ => Ok(()),
    };
    for name in FILES {
        remove(&folder.join(name))?;
    }
    let folders = FOLDERS.map(|name| folder.join(name)).into_iter();
    for own in folders.filter(|f| f.is_dir()) {
        for entry in std::fs::read_dir(own)? {
            let file = entry?.path();
            let ending = file.extension().and_then(|e| e.to_str());
            if ending.is_some_and(|e| ["png", "svg", "pdf"].contains(&e)) {
                remove(&file)?;
            }
        }
    }
    Ok(())
}

/// Removes what a run without a result wrote: all of `folder` if the run has `made` it, else the run's
/// own files.
pub fn discard(folder: &Path, made: bool) -> Result<()> {
    let removed = match made {
        true => std::fs::remove_dir_all(folder),
        false => clear(folder),
    };
    removed.map_err(|e| {
        let message = format!("the files of the run cannot be removed ({e})");
        Error::new(ErrorKind::File, message).in_file(folder)
    })
}

/// `raw.csv`: every sample. Rows of `results.csv`, passes and rounds count from 1.
pub fn raw(rows: &[Row]) -> Table {
    let header = "row,scene,stage,solver,pass,round,gpu_ms,frame_ms,change_ms";
    let mut table = Table::new(header.split(','), Vec::new());
    for (number, row) in rows.iter().enumerate() {
        for (pass, samples) in row.passes.iter().enumerate() {
            for (round, sample) in samples.iter().enumerate() {
                let mut record = named(Some(number), &row.scene, &row.settings).to_vec();
                record.extend([pass + 1, round + 1].map(|n| n.to_string()));
                let text = |ms| names::number(ms, 7);
                record.push(sample.gpu_ms.map_or(String::new(), text));
                record.push(text(sample.frame_ms));
                record.push(sample.change_ms.map_or(String::new(), text));
                table.records.push(record);
            }
        }
    }
    table
}

/// The cells that name a row (counted from 1) or a measurement that could not be made.
fn named(row: Option<usize>, scene: &str, settings: &MethodSettings) -> [String; 4] {
    [
        row.map_or(String::new(), |number| (number + 1).to_string()),
        scene.to_owned(),
        settings.stage.name().to_owned(),
        settings.method.to_string(),
    ]
}

/// The rows in no summary, and why: those whose clocks disagree (`row` is their number in
/// `results.csv`), and measurements that could not be made (`row` is empty).
pub fn excluded(plan: &Plan, measured: &Measured) -> Table {
    let header = ["row", "scene", "stage", "solver", "reason"];
    let mut table = Table::new(header, Vec::new());
    let mut add = |name: [String; 4], reason: &str| {
        let record = [&name[..], &[reason.to_owned()]].concat();
        table.records.push(record);
    };
    for (number, row) in measured.rows.iter().enumerate() {
        if let Clocks::Disagree { gpu_ms, frame_ms } = row.clocks() {
            let [gpu, wall] = [gpu_ms, frame_ms].map(|ms| names::number(ms, 4));
            let apart = 100.0 * CLOCKS_APART;
            let reason = format!(
                "the device's clock says {gpu} ms, the wall clock {wall} ms: more than {apart:.0} % apart, without {SUBMISSION_MS} ms of submission, though each pass was measured up to {TRIES} times"
            );
            add(named(Some(number), &row.scene, &row.settings), &reason);
        }
    }
    for (case, reason) in &measured.left_out {
        let scene = plan.views.get(case.view).map_or("", |v| &v.name);
        add(named(None, scene, &case.settings), reason);
    }
    table
}

/// A warning about rows that are in no summary since their clocks differ.
pub fn clock_warning(rows: &[Row]) -> Option<String> {
    let differs = |row: &&Row| matches!(row.clocks(), Clocks::Disagree { .. });
    let count = rows.iter().filter(differs).count();
    (count > 0).then(|| {
        format!(
            "{count} of {} rows left out (clocks differ in {TRIES} tries): frames are too short, or other programs run; take a larger --size, or an idle machine",
            rows.len()
        )
    })
}

/// Writes `results.csv`, `raw.csv` and what was drawn.
pub fn write_rows(
    folder: &Path,
    rows: &[Row],
    plan: &Plan,
    machine: &Machine,
    resolved: f64,
) -> Result<()> {
    let results = results_table(rows, plan, machine, resolved)?;
    write_text(&folder.join("results.csv"), &results.csv())?;
    write_text(&folder.join("raw.csv"), &raw(rows).csv())?;
    write_text(&folder.join(drawn::FILE), &Drawn::of(plan).text()?)
}

/// Writes the files that every run has.
pub fn write(
    folder: &Path,
    plan: &Plan,
    measured: &Measured,
    machine: &Machine,
    resolved: f64,
) -> Result<()> {
    make(folder)?;
    write_rows(folder, &measured.rows, plan, machine, resolved)?;
    let excluded = excluded(plan, measured).csv();
    write_text(&folder.join("excluded.csv"), &excluded)?;
    let line = |(what, which): &(&str, String)| format!("{what}: {which}\n");
    let note: String = machine.lines.iter().map(line).collect();
    write_text(&folder.join("machine.txt"), &note)
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    #[test]
    fn rows_whose_clocks_differ_are_counted_in_a_warning() {
        let row = crate::measure::row::tests::row;
        let fine = row(&[&[(Some(20.0), 21.0)]]);
        let differs = row(&[&[(Some(0.036), 20.0)]]);
        assert_eq!(clock_warning(std::slice::from_ref(&fine)), None);
        let warning = clock_warning(&[fine, differs]).unwrap();
        assert!(warning.starts_with("1 of 2 rows left out (clocks differ in 3 tries)"));
    }

    #[test]
    fn an_earlier_run_is_kept_unless_it_may_be_replaced() {
        let base = tempfile::tempdir().unwrap();
        let out = base.path().join("run");
        let claimed = |overwrite| claim(&out, overwrite, [base.path().join("a.toml").as_path()]);
        claimed(false).unwrap();
        // An empty folder, and one with files of others, are as good as a new one.
        write_text(&out.join("notes.txt"), "mine").unwrap();
        claimed(false).unwrap();
        make(&out.join("pictures")).unwrap();
        for name in ["results.csv", "pictures/a.png", "pictures/own.txt"] {
            write_text(&out.join(name), "earlier").unwrap();
        }
        let error = claimed(false).unwrap_err();
        assert_eq!(error.kind, ErrorKind::Usage);
        assert!(error.to_string().contains("--overwrite"), "{error}");
        assert!(out.join("results.csv").exists() && out.join("pictures/a.png").exists());
        claimed(true).unwrap();
        assert!(!out.join("results.csv").exists() && !out.join("pictures/a.png").exists());
        let own = || out.join("notes.txt").exists() && out.join("pictures/own.txt").exists();
        assert!(own());
        write_text(&out.join("results.csv"), "empty").unwrap();
        discard(&out, false).unwrap();
        assert!(own() && !out.join("results.csv").exists());
        discard(&out, true).unwrap();
        assert!(!out.exists());
    }

    #[cfg(target_os = "linux")]
    #[test]
    fn inputs_are_not_written_over() {
        use std::os::unix::ffi::OsStrExt;
        let base = tempfile::tempdir().unwrap();
        make(&base.path().join("pictures")).unwrap();
        let names: [(&[u8], bool); 4] = [
            (b"scene.toml", false),
            (b"pictures/vase.png", true),
            (b"machine.txt", true),
            // A name that is no text.
            (b"pictures/\xff.png", true),
        ];
        for (name, refused) in names {
            let name = std::ffi::OsStr::from_bytes(name);
            let input = base.path().join(name);
            write_text(&input, "").unwrap();
            let claimed = claim(base.path(), true, [input.as_path()]);
            assert_eq!(claimed.is_err(), refused, "{name:?}");
            assert!(input.exists());
        }
    }
}
