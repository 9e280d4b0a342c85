//! Times in proportion to those of other rows, over all views: the tables that say which way of
//! drawing is faster, and how sure that is.

use super::plan::{is_rbm_baseline, variant};
use super::row::Row;
use super::stats::{self, Interval};
use crate::method::{Edges, Method, MethodSettings};
use revmap::settings::{DrawStage, Tolerance};

/// The row that others are put in proportion to.
#[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Over {
    /// The RBM baseline in the same picture and stage.
    Baseline,
    /// The default search in the same picture and stage: exact, one ray per pixel.
    Exact,
    /// The plan's first view drawn in the same way; of the floor, the default search.
    One,
    /// The least value of the form's parameter drawn in the same way.
    First,
    /// A mesh of the same picture in the fragment stage.
    Mesh,
}

impl Over {
    /// The other row of a row. Of meshes the coarsest that errs no more in depth.
    #[must_use]
    pub fn of<'a>(self, rows: &'a [Row], row: &Row) -> Option<&'a Row> {
        let stage = |r: &Row| same_picture(r, row) && r.settings.stage == row.settings.stage;
        let find =
            |wanted: &dyn Fn(&Row) -> bool| rows.iter().find(|r| wanted(r) && r.time().is_some());
        match self {
            Self::Baseline => find(&|r| is_rbm_baseline(&r.settings) && stage(r)),
            Self::Exact => find(&|r| {
                let s = &r.settings;
                s.method == Method::DEFAULT
                    && (s.tolerance, s.edges) == (Tolerance::EXACT, Edges::OneRay)
                    && stage(r)
            }),
            Self::One => {
                let mut like = row.settings;
                if like.method == Method::Floor {
                    like.method = Method::DEFAULT;
                }
                find(&|r| r.view == 0 && row.view > 0 && r.settings == like)
            }
            Self::First => {
                let same = |r: &&Row| r.settings == row.settings && r.sweeps == row.sweeps;
                let valued = rows.iter().filter(same).filter(|r| r.value.is_some());
                valued.min_by(|a, b| {
                    a.value
                        .partial_cmp(&b.value)
                        .unwrap_or(std::cmp::Ordering::Equal)
                })
            }
            Self::Mesh => mesh_row(rows, row, None),
        }
    }
}

/// The row of a mesh that shows the same picture: of this one, or of the coarsest that errs no more.
fn mesh_row<'a>(rows: &'a [Row], row: &Row, mesh: Option<Method>) -> Option<&'a Row> {
    rows.iter()
        .filter(|r| r.settings.method.is_mesh() && same_picture(r, row) && r.time().is_some())
        .filter(|r| match mesh {
            Some(mesh) => r.settings.method == mesh,
            None => errs_no_more(r, row),
        })
        .min_by_key(|r| r.settings.method.quads())
}

/// A way of drawing over other rows: all pictures of which both have a usable row.
#[derive(Clone, Debug)]
pub struct Ratio<'a> {
    /// The way, without its size.
    pub settings: MethodSettings,
    /// The mesh that it is put over, in tables over meshes; `None`: in each picture the coarsest
    /// that errs no more in depth.
    pub mesh: Option<Method>,
    /// Time over the other's: the geometric mean over views and sizes, with its 95 % interval.
    pub time: Interval,
    /// The least and the greatest ratio of a single view and size.
    pub range: (f64, f64),
    /// Each row and the other one.
    pub pairs: Vec<(&'a Row, &'a Row)>,
}

impl Ratio<'_> {
    /// Missed and ghost pixels over the pixels hit, all pictures together.
    #[must_use]
    pub fn wrong(&self) -> f64 {
        let sum = |f: fn(&Row) -> usize| self.pairs.iter().map(|(a, _)| f(a)).sum::<usize>() as f64;
        sum(|r| r.errors.missed + r.errors.ghost) / sum(|r| r.errors.hits).max(1.0)
    }

    /// In how many of the pictures the other row errs no more in depth: only there a ratio of times
    /// is one of equals.
    #[must_use]
    pub fn no_worse(&self) -> usize {
        self.pairs
            .iter()
            .filter(|(row, other)| errs_no_more(other, row))
            .count()
    }
}

/// Every way's ratio, those of the fragment stage first; over meshes those of the default
/// search alone, for each mesh and then for the coarsest that errs no more. Rows whose clocks
/// disagree count for nothing, and neither do pictures of which the other has no usable row.
#[must_use]
pub fn over(rows: &[Row], over: Over) -> Vec<Ratio<'_>> {
    let all = ways(rows);
    if over != Over::Mesh {
        let of = |way: &MethodSettings| of_way(rows, way, None, |row| over.of(rows, row));
        return all.iter().filter_map(of).collect();
    }
    let meshes: Vec<Method> = all
        .iter()
        .map(|w| w.method)
        .filter(|m| m.is_mesh())
        .collect();
    let none = (!meshes.is_empty()).then_some(None);
    let rivals: Vec<Option<Method>> = meshes.into_iter().map(Some).chain(none).collect();
    let ours = all.iter().filter(|w| w.method == Method::DEFAULT);
    let of = |way| {
        let against =
            move |mesh: &Option<Method>| of_way(rows, way, *mesh, |row| mesh_row(rows, row, *mesh));
        rivals.iter().filter_map(against).collect::<Vec<_>>()
    };
    ours.flat_map(of).collect()
}

/// True if the depth error of a row (99th percentile) is no more than that of another.
fn errs_no_more(row: &Row, other: &Row) -> bool {
    let p99 = |r: &Row| r.errors.depth.map(|d| d.p99);
    p99(row).zip(p99(other)).is_some_and(|(a, b)| a <= b)
}

/// The ways of drawing, in the order in which they first appear.
pub(super) fn ways(rows: &[Row]) -> Vec<MethodSettings> {
    let mut ways: Vec<MethodSettings> = Vec::new();
    for way in rows.iter().map(|row| variant(&row.settings)) {
        if !ways.contains(&way) {
            ways.push(way);
        }
    }
    // Those of the fragment stage first.
    ways.sort_by_key(|way| way.stage == DrawStage::Compute);
    ways
}

/// A way over the row that `other` gives for each of its rows.
fn of_way<'a>(
    rows: &'a [Row],
    way: &MethodSettings,
    mesh: Option<Method>,
    other: impl Fn(&Row) -> Option<&'a Row>,
) -> Option<Ratio<'a>> {
    let own = rows
        .iter()
        .filter(|r| variant(&r.settings) == *way && r.time().is_some());
    let pairs: Vec<(&Row, &Row)> = own.filter_map(|row| Some((row, other(row)?))).collect();
    let passes = pairs.first()?.0.passes.len();
    let in_pass = |pass: usize| -> Vec<f64> {
        pairs
            .iter()
            .filter_map(|(a, b)| paired(a, b, pass))
            .collect()
    };
    // A pass that was ended early holds fewer pictures and would compare others.
    let whole = |logs: &Vec<f64>| logs.len() == pairs.len();
    let all: Vec<Vec<f64>> = (0..passes).map(in_pass).filter(whole).collect();
    let mean = |logs: &Vec<f64>| (logs.iter().sum::<f64>() / logs.len() as f64).exp();
    let time = stats::geometric(&all.iter().map(mean).collect::<Vec<_>>())?;
    let single = (0..pairs.len()).map(|k| mean(&all.iter().map(|logs| logs[k]).collect()));
    Some(Ratio {
        settings: *way,
        mesh,
        time,
        range: single.fold((f64::INFINITY, 0.0), |(l, h), v| (l.min(v), h.max(v))),
        pairs,
    })
}

/// The time of a row above the floor of its picture and stage, ms: the floor at its tolerance, if
/// that was measured, else the exact one. `None` where the floor is not known, and of the floor
/// itself.
#[must_use]
pub fn above_floor(rows: &[Row], row: &Row) -> Option<f64> {
    let of_this = |r: &&Row| {
        r.settings.method == Method::Floor
            && same_picture(r, row)
            && r.settings.stage == row.settings.stage
    };
    let alike = |r: &&Row| r.settings.tolerance == row.settings.tolerance;
    let mut floors = rows.iter().filter(of_this);
    let floor = floors.clone().find(alike).or_else(|| floors.next())?;
    let above = row.time()?.value - floor.time()?.value;
    (row.settings.method != Method::Floor).then_some(above)
}

/// True if two rows show the same view at the same size.
fn same_picture(a: &Row, b: &Row) -> bool {
    let key = |r: &Row| (r.view, r.settings.width, r.settings.height);
    key(a) == key(b)
}

/// The time of `a` over that of `b`, two rows that were drawn in turn; `None` where a clock cannot
/// be trusted.
#[must_use]
pub fn between(a: &Row, b: &Row) -> Option<Interval> {
    a.time().and(b.time())?;
    let passes = a.passes.len().min(b.passes.len());
    let ratios: Vec<f64> = (0..passes)
        .filter_map(|pass| paired(a, b, pass))
        .map(f64::exp)
        .collect();
    stats::geometric(&ratios)
}

/// Logarithm of the median ratio of samples that were taken in the same round.
fn paired(a: &Row, b: &Row, pass: usize) -> Option<f64> {
    let (a, b) = (a.passes.get(pass)?, b.passes.get(pass)?);
    let logs: Vec<f64> = a
        .iter()
        .zip(b)
        .map(|(a, b)| (Row::sample_ms(a) / Row::sample_ms(b)).ln())
        .collect();
    stats::median(&logs).filter(|v| v.is_finite())
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::super::plan::rbm_baseline;
    use super::super::row::tests::row;
    use super::super::view::tests::spindle;
    use super::*;
    use crate::method::Method;

    fn papers(mut row: Row) -> Row {
        row.settings = rbm_baseline(&spindle(), &row.settings);
        row
    }

    /// A machine that slows down to a third within a pass and between passes changes no ratio.
    #[test]
    fn drift_of_the_machine_cancels() {
        let ours = row(&[&[(None, 10.0), (None, 30.0)], &[(None, 20.0), (None, 11.0)]]);
        let theirs = papers(row(&[
            &[(None, 20.0), (None, 60.0)],
            &[(None, 40.0), (None, 22.0)],
        ]));
        let rows = [ours, theirs];
        let ratios = over(&rows, Over::Baseline);
        assert_eq!(ratios.len(), 2);
        let time = ratios[0].time;
        assert!(
            (time.value - 0.5).abs() < 1e-12 && (time.high - time.low) < 1e-9,
            "{time:?}"
        );
        assert!((ratios[1].time.value - 1.0).abs() < 1e-12);
    }

    #[test]
    fn views_are_averaged_geometrically() {
        let mut rows = Vec::new();
        for (view, ours) in [5.0, 20.0].into_iter().enumerate() {
            let mut a = row(&[&[(None, ours)], &[(None, ours)]]);
            let mut b = papers(row(&[&[(None, 20.0)], &[(None, 20.0)]]));
            (a.view, b.view) = (view, view);
            rows.extend([a, b]);
        }
        let ratio = &over(&rows, Over::Baseline)[0];
        assert!((ratio.time.value - 0.5).abs() < 1e-12);
        assert!((ratio.range.0 - 0.25).abs() < 1e-12 && (ratio.range.1 - 1.0).abs() < 1e-12);
        assert_eq!(ratio.pairs.len(), 2);
    }

    #[test]
    fn what_cannot_be_trusted_counts_for_nothing() {
        let lies = row(&[&[(Some(0.04), 20.0)]]);
        let fine = papers(row(&[&[(Some(20.0), 20.0)]]));
        let rows = [lies.clone(), fine.clone()];
        let ratios = over(&rows, Over::Baseline);
        assert_eq!(ratios.len(), 1, "only the RBM baseline itself");
        // A rival that lies leaves nothing to compare with, and another stage or size is no rival.
        assert!(over(&[row(&[&[(None, 20.0)]]), papers(lies)], Over::Baseline).is_empty());
        let mut compute = row(&[&[(None, 20.0)]]);
        compute.settings.stage = DrawStage::Compute;
        assert_eq!(over(&[compute, fine], Over::Baseline).len(), 1);
    }

    /// 8 ms against 20 where 5 go without a search: 3 of the 20 are above the floor.
    #[test]
    fn the_floor_is_taken_off() {
        let timed = |ms: f64| row(&[&[(None, ms)], &[(None, ms)]]);
        let mut floor = timed(5.0);
        floor.settings.method = Method::Floor;
        let mut compute = timed(6.0);
        compute.settings.stage = DrawStage::Compute;
        let rows = [timed(8.0), floor, papers(timed(20.0)), compute];
        let above = |k: usize| above_floor(&rows, &rows[k]).map(|ms| ms.round());
        assert_eq!([0, 1, 2, 3].map(above), [Some(3.0), None, Some(15.0), None]);
    }

    /// A run that was ended in its second pass: the picture that lacks the pass must not shift the
    /// mean.
    #[test]
    fn a_pass_that_was_ended_early_is_left_out() {
        let mut rows = Vec::new();
        for (view, ours) in [5.0, 20.0].into_iter().enumerate() {
            let passes: &[&[(Option<f64>, f64)]] = &[&[(None, ours)], &[(None, ours)]];
            let count = if view == 0 { 2 } else { 1 };
            let mut a = row(&passes[..count]);
            let mut b = papers(row(
                &[[(None, 20.0)].as_slice(), [(None, 20.0)].as_slice()][..count]
            ));
            (a.view, b.view) = (view, view);
            rows.extend([a, b]);
        }
        let time = over(&rows, Over::Baseline)[0].time;
        assert!((time.value - 0.5).abs() < 1e-12 && time.high == f64::INFINITY);
    }

    /// Coarse meshes are fast and wrong: the ratio that counts is that to the coarsest which is
    /// not.
    #[test]
    fn the_default_search_is_held_against_meshes() {
        let depth = |p99| {
            Some(crate::compare::Spread {
                rms: p99,
                p99,
                max: p99,
            })
        };
        let timed = |method, ms: f64, p99| {
            let mut row = row(&[&[(None, ms)], &[(None, ms)]]);
            row.settings.method = method;
            row.errors.depth = depth(p99);
            row
        };
        let mesh = |n| Method::mesh(n, 2 * n).unwrap();
        let rows = [
            timed(Method::DEFAULT, 9.0, 0.01),
            timed(mesh(64), 6.0, 0.5),
            timed(mesh(512), 36.0, 0.009),
            timed(mesh(256), 18.0, 0.01),
        ];
        let duels = over(&rows, Over::Mesh);
        let told: Vec<_> = duels
            .iter()
            .map(|d| (d.mesh, (d.time.value * 100.0).round(), d.no_worse()))
            .collect();
        assert_eq!(
            told,
            [
                (Some(mesh(64)), 150.0, 0),
                (Some(mesh(512)), 25.0, 1),
                (Some(mesh(256)), 50.0, 1),
                (None, 50.0, 1)
            ]
        );
        // Without a mesh that errs no more there is no such ratio, and without the default search
        // none at all.
        assert_eq!(over(&rows[..2], Over::Mesh).len(), 1);
        assert!(over(&rows[1..], Over::Mesh).is_empty());
    }
}
