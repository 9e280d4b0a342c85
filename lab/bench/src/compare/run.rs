//! A run read back from its folder.

use crate::measure::drawn::Drawn;
use crate::measure::surroundings;
use crate::report::columns::{CONTRACT, results as columns};
use revmap::error::{Error, ErrorKind, Result};
use revmap::settings::Solver;
use revmap_figures::stats;
use revmap_figures::table::{A_RUN, Table, text_of};
use std::collections::BTreeMap;
use std::path::Path;

pub(super) struct Run {
    /// `results.csv`.
    pub(super) results: Table,
    /// Times of each row (counted from 1) in each pass.
    samples: BTreeMap<(usize, usize), Vec<f64>>,
    /// The processor, with its threads; empty without `machine.txt`.
    processor: String,
    /// What it drew; none for a run of an earlier version.
    pub(super) drawn: Option<Drawn>,
    /// What else changes times; empty for a run of an earlier version.
    pub(super) surroundings: BTreeMap<String, String>,
}

/// A record of `raw.csv`.
#[derive(serde::Deserialize)]
struct Sample {
    row: usize,
    pass: usize,
    gpu_ms: Option<f64>,
    frame_ms: f64,
}

/// Columns that make a row the RBM baseline, and their values.
const BASELINE: [(&str, &[&str]); 4] = [
    ("solver", &["circle"]),
    ("max_steps", &["20", "25"]),
    ("map_source", &["binary"]),
    ("map_format", &["rgba8"]),
];

/// Columns that name a picture.
pub(super) const PICTURE: [&str; 8] = [
    "scene",
    "technique",
    "extend",
    "bevel",
    "chamfer",
    "width",
    "height",
    "objects",
];

impl Run {
    /// Reads the folder of a run.
    pub(super) fn load(folder: &Path) -> Result<Self> {
        let file = folder.join("results.csv");
        let mut results = Table::load(&file)?;
        // Later versions may add columns.
        let header = results.header.iter().take(CONTRACT);
        if !header.eq(columns().take(CONTRACT)) {
            let message = "has other columns than this version writes; measure again";
            return Err(Error::new(ErrorKind::File, message).in_file(file));
        }
        let solver = results.column("solver")?;
        for record in &mut results.records {
            // Its name in runs of earlier versions.
            if record[solver] == "hull" {
                Solver::Exact.name().clone_into(&mut record[solver]);
            }
        }
        let samples = samples(&folder.join("raw.csv"), &results)?;
        // Tables that were put together from several runs have none.
        let note = std::fs::read_to_string(folder.join("machine.txt"));
        let note = note.unwrap_or_default();
        Ok(Self {
            results,
            samples,
            drawn: Drawn::load(folder)?,
            processor: surroundings::field(&note, "processor").unwrap_or_default(),
            surroundings: surroundings::of_note(&note),
        })
    }

    /// A field of a record; empty where the run lacks the column.
    pub(super) fn at<'a>(&self, record: &'a [String], name: &str) -> &'a str {
        let place = self.results.column(name);
        place.map_or("", |place| record[place].as_str())
    }

    /// The times of a row (counted from 0) by pass, in the order of their rounds; none where its
    /// clocks disagree.
    fn times(&self, row: usize) -> impl Iterator<Item = &[f64]> {
        let passes = self.samples.range((row + 1, 0)..(row + 2, 0));
        passes.map(|(_, times)| times.as_slice())
    }

    pub(super) fn medians(&self, row: usize) -> Vec<f64> {
        self.times(row).filter_map(stats::median).collect()
    }

    /// A row's time over the RBM baseline's in the same picture and in this stage: of each pass the
    /// median over the rounds. `None` where a clock was rejected, and without such a baseline.
    pub(super) fn over_baseline(&self, row: usize, stage: &str) -> Option<Vec<f64>> {
        let rival = self.baseline_of(self.results.records.get(row)?, stage)?;
        let passes = self.times(row).zip(self.times(rival));
        let log = |(a, b): (&[f64], &[f64])| stats::log_ratio(a.iter().copied(), b.iter().copied());
        let ratios: Vec<f64> = passes.filter_map(log).map(f64::exp).collect();
        (!ratios.is_empty()).then_some(ratios)
    }

    pub(super) fn is_baseline(&self, record: &[String]) -> bool {
        let mut columns = BASELINE.iter();
        columns.all(|(column, values)| values.contains(&self.at(record, column)))
    }

    /// True if a record shows a picture of another run's, to the same tolerance, as far as both
    /// have the columns.
    pub(super) fn same_picture(
        &self,
        record: &[String],
        (other, twin): (&Self, &[String]),
    ) -> bool {
        let mut names = PICTURE.iter().chain(&["tolerance_px", "way"]);
        names.all(|name| {
            let places = (self.results.column(name), other.results.column(name));
            !matches!(places, (Ok(a), Ok(b)) if record[a] != twin[b])
        })
    }

    /// The row (counted from 0) of the RBM baseline in a record's picture and in this stage.
    fn baseline_of(&self, record: &[String], stage: &str) -> Option<usize> {
        let same = |r: &[String]| PICTURE.iter().all(|c| self.at(r, c) == self.at(record, c));
        let mut records = self.results.records.iter();
        records.position(|r| self.is_baseline(r) && self.at(r, "stage") == stage && same(r))
    }

    /// The sum of some columns of a row; none where one is empty.
    pub(super) fn sum(&self, row: usize, columns: &[&str]) -> Option<f64> {
        let record = self.results.records.get(row)?;
        columns
            .iter()
            .map(|c| self.at(record, c).parse::<f64>().ok())
            .sum()
    }

    /// A field of the first record; empty where unknown.
    pub(super) fn first(&self, name: &str) -> &str {
        let first = self.results.records.first();
        first.map_or("", |record| self.at(record, name))
    }

    /// Device, driver and processor by name, without those that are unknown.
    pub(super) fn machine(&self) -> BTreeMap<String, String> {
        let named = ["device", "driver"].map(|name| (name, self.first(name)));
        let all = named
            .into_iter()
            .chain([("processor", self.processor.as_str())]);
        let known = all.filter(|(_, value)| !value.is_empty());
        known
            .map(|(name, value)| (name.to_owned(), format!("{value:?}")))
            .collect()
    }
}

/// Reads the times of `raw.csv`.
fn samples(file: &Path, results: &Table) -> Result<BTreeMap<(usize, usize), Vec<f64>>> {
    let fault = |e: csv::Error| {
        let message = format!("{e}; measure again");
        Error::new(ErrorKind::File, message).in_file(file)
    };
    let gpu = results.column("gpu_ms_median")?;
    let mut samples: BTreeMap<(usize, usize), Vec<f64>> = BTreeMap::new();
    let text = text_of(file, A_RUN)?;
    for sample in csv::Reader::from_reader(text.as_bytes()).deserialize() {
        let sample: Sample = sample.map_err(fault)?;
        let record = results.records.get(sample.row.wrapping_sub(1));
        let told = record.is_some_and(|r| !r[gpu].is_empty());
        let ms = match sample.gpu_ms {
            Some(ms) => told.then_some(ms),
            None => (!told).then_some(sample.frame_ms),
        };
        // A device's clock that was rejected has its wall clock in doubt as well.
        let pass = samples.entry((sample.row, sample.pass)).or_default();
        pass.extend(ms);
    }
    Ok(samples)
}
