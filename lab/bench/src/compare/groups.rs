//! Rows of several runs, put together by what they measure: the figures of each run over the
//! pictures that all of them have.

use super::run::Run;
use super::scenes::Scenes;
use crate::plan::RBM_BASELINE;
use revmap_figures::stats;

/// The words for a row among others; rows of equal words are one group.
pub(super) type By<'a> = &'a dyn Fn(&Run, &[String]) -> Vec<String>;

/// Rows (counted from 0) of one kind.
pub(super) struct Group {
    pub(super) key: Vec<String>,
    /// Of each picture of the first run the row in every run.
    pub(super) pictures: Vec<Vec<Option<usize>>>,
}

/// The rows of the first run in groups, each beside those of the same picture in the others. Views
/// of different scenes under one name are not the same picture.
pub(super) fn groups(runs: &[Run], scenes: &[Scenes], by: By) -> Vec<Group> {
    let keys = |run: &Run| -> Vec<_> { run.results.records.iter().map(|r| by(run, r)).collect() };
    let keys: Vec<Vec<_>> = runs.iter().map(keys).collect();
    let mut all: Vec<Group> = Vec::new();
    let Some((first, own)) = runs.first().zip(keys.first()) else {
        return all;
    };
    for (row, (record, key)) in first.results.records.iter().zip(own).enumerate() {
        let twin = |other: usize| {
            let differs = |s: &Scenes| s.differ(first.at(record, "scene"));
            let run = runs.get(other).filter(|_| !differs(&scenes[other]))?;
            let mut records = run.results.records.iter().zip(&keys[other]);
            let same = |r: &[String]| first.same_picture(record, (run, r));
            records.position(|(r, other)| other == key && same(r))
        };
        let others = (1..runs.len()).map(twin);
        let picture = std::iter::once(Some(row)).chain(others).collect();
        match all.iter_mut().find(|group| group.key == *key) {
            Some(group) => group.pictures.push(picture),
            None => all.push(Group {
                key: key.clone(),
                pictures: vec![picture],
            }),
        }
    }
    all
}

/// A figure of the pictures that all runs have.
pub(super) struct Common<T> {
    /// Of each run the values of these pictures.
    pub(super) values: Vec<Vec<T>>,
    /// In how many pictures the first run has a value.
    pub(super) of: usize,
}

impl Group {
    /// The values of the pictures in which every run has one.
    pub(super) fn common<T>(
        &self,
        runs: &[Run],
        value: impl Fn(&Run, usize) -> Option<T>,
    ) -> Common<T> {
        let own = |(run, row): (&Run, &Option<usize>)| value(run, (*row)?);
        let all = |picture: &Vec<Option<usize>>| -> Vec<Option<T>> {
            runs.iter().zip(picture).map(own).collect()
        };
        let mut found: Vec<Vec<Option<T>>> = self.pictures.iter().map(all).collect();
        found.retain(|values| values.first().is_some_and(Option::is_some));
        let of = found.len();
        found.retain(|values| values.iter().all(Option::is_some));
        let mut values: Vec<Vec<T>> = runs.iter().map(|_| Vec::new()).collect();
        for (own, value) in found.into_iter().flat_map(|all| (0..).zip(all)) {
            values[own].extend(value);
        }
        Common { values, of }
    }

    /// Logarithms of the times of each pass, over the RBM baseline in the fragment stage, or in
    /// milliseconds.
    pub(super) fn times(&self, runs: &[Run], over_baseline: bool) -> Common<Vec<f64>> {
        self.common(runs, |run, row| {
            let times = match over_baseline {
                true => run.over_baseline(row, "fragment")?,
                false => run.medians(row),
            };
            (!times.is_empty()).then(|| times.into_iter().map(f64::ln).collect())
        })
    }

    /// The sum of some columns.
    pub(super) fn errors(&self, runs: &[Run], columns: &[&str]) -> Common<f64> {
        self.common(runs, |run, row| run.sum(row, columns))
    }
}

/// The errors that runs are compared by: what they are called, the columns whose sum is the error
/// of a picture, and the figure of several pictures.
pub(super) type Error = (
    &'static str,
    &'static [&'static str],
    fn(&[f64]) -> Option<f64>,
);
/// Missed and ghost pixels.
pub(super) const WRONG: Error = ("wrong pixels", &["missed", "ghost"], |all| {
    Some(all.iter().sum())
});
/// Depths, the 99th percentile.
pub(super) const DEPTH: Error = ("h/512 of depth error", &["depth_p99_texels"], |all| {
    let above: Vec<f64> = all.iter().map(|d| d.max(1e-4)).collect();
    stats::geometric(&above).map(|mean| mean.value)
});

/// A row's method: its solver, or the RBM baseline.
pub(super) fn method(run: &Run, record: &[String]) -> String {
    match run.is_baseline(record) {
        true => RBM_BASELINE.to_owned(),
        false => run.at(record, "solver").to_owned(),
    }
}
