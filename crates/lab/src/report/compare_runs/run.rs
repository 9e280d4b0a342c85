//! A run read back from its folder.

use crate::report::columns::{CONTRACT, results as columns};
use crate::report::machine;
use crate::report::stats;
use crate::report::table::Table;
use revmap::error::{Error, ErrorKind, Result};
use revmap::settings::Solver;
use std::collections::HashMap;
use std::path::Path;

/// A run as read.
pub(super) struct Run {
    /// `results.csv`.
    pub(super) results: Table,
    /// Each row's medians by pass.
    pub(super) medians: HashMap<usize, Vec<f64>>,
    /// The processor, with its threads; empty without `machine.txt`.
    processor: String,
}

/// Columns that make a row the RBM baseline, and their values.
const BASELINE: [(&str, &[&str]); 4] = [
    ("solver", &["circle"]),
    ("max_steps", &["20", "25"]),
    ("map_source", &["binary"]),
    ("map_format", &["rgba8"]),
];

impl Run {
    /// Reads the folder of a run.
    pub(super) fn load(folder: &Path) -> Result<Self> {
        let mut results = Table::load(&folder.join("results.csv"))?;
        // Later versions may add columns.
        let mut header = results.header.iter().map(String::as_str).take(CONTRACT);
        if !columns()
            .take(CONTRACT)
            .all(|name| header.next() == Some(name))
        {
            return Err(Error::new(
                ErrorKind::File,
                "has other columns than this version writes; measure again",
            )
            .in_file(folder.join("results.csv")));
        }
        let solver = results.column("solver")?;
        for record in &mut results.records {
            // Its name in runs of earlier versions.
            if record[solver] == "hull" {
                Solver::Exact.name().clone_into(&mut record[solver]);
            }
        }
        let raw_file = folder.join("raw.csv");
        let raw = Table::load(&raw_file)?;
        let named = |name: &str| raw.column(name).map_err(|e| e.in_file(&raw_file));
        let (row, pass, gpu, frame) = (
            named("row")?,
            named("pass")?,
            named("gpu_ms")?,
            named("frame_ms")?,
        );
        let mut samples: HashMap<usize, HashMap<usize, Vec<f64>>> = HashMap::new();
        let gpu_column = results.column("gpu_ms_median")?;
        for record in &raw.records {
            let whole = |at: usize| {
                record[at].parse::<usize>().map_err(|_| {
                    Error::new(
                        ErrorKind::File,
                        format!("{:?} is no number; measure again", record[at]),
                    )
                    .in_file(&raw_file)
                })
            };
            let row = whole(row)?;
            let told = results
                .records
                .get(row.wrapping_sub(1))
                .is_some_and(|r| !r[gpu_column].is_empty());
            let ms = record[if told { gpu } else { frame }].parse::<f64>();
            // A device's clock that was rejected has its wall clock in doubt as well.
            let rejected = !told && !record[gpu].is_empty();
            if let (Ok(ms), false) = (ms, rejected) {
                samples
                    .entry(row)
                    .or_default()
                    .entry(whole(pass)?)
                    .or_default()
                    .push(ms);
            }
        }
        let medians = samples.into_iter().map(|(row, passes)| {
            let mut passes: Vec<_> = passes.into_iter().collect();
            passes.sort_by_key(|(pass, _)| *pass);
            (
                row,
                passes
                    .iter()
                    .filter_map(|(_, times)| stats::median(times))
                    .collect(),
            )
        });
        // Tables that were put together from several runs have none.
        let note = std::fs::read_to_string(folder.join("machine.txt")).unwrap_or_default();
        Ok(Self {
            results,
            medians: medians.collect(),
            processor: machine::field(&note, "processor", ':').unwrap_or_default(),
        })
    }

    /// The passes' medians of a row (counted from 1), each over that of the RBM baseline which
    /// shows the same picture in the same stage.
    pub(super) fn over_baseline(&self, row: usize) -> Option<Vec<f64>> {
        let at = |name: &str| columns().position(|c| c == name);
        let record = self.results.records.get(row.checked_sub(1)?)?;
        let is_baseline = |r: &[String]| {
            BASELINE
                .iter()
                .all(|(c, values)| at(c).is_some_and(|k| values.contains(&r[k].as_str())))
        };
        if is_baseline(record) {
            return None;
        }
        let picture = [
            "scene",
            "technique",
            "extend",
            "bevel",
            "chamfer",
            "stage",
            "width",
            "height",
            "objects",
        ];
        let same = |r: &[String]| {
            picture
                .iter()
                .all(|c| at(c).is_some_and(|k| r[k] == record[k]))
        };
        let rival = self
            .results
            .records
            .iter()
            .position(|r| is_baseline(r) && same(r))?
            + 1;
        let (own, rival) = (self.medians.get(&row)?, self.medians.get(&rival)?);
        Some(own.iter().zip(rival).map(|(a, b)| a / b).collect())
    }

    /// Device, driver and processor, each with its name; empty where unknown.
    pub(super) fn machine(&self) -> [(&'static str, String); 3] {
        let first = |name: &str| {
            let at = self.results.column(name).ok()?;
            Some(self.results.records.first()?[at].clone())
        };
        let named = |name| (name, first(name).unwrap_or_default());
        [
            named("device"),
            named("driver"),
            ("processor", self.processor.clone()),
        ]
    }
}
