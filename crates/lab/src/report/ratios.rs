//! Times in proportion to a rival's, over all views: the tables that say which search is faster,
//! and how sure that is.

use super::plan::{is_rbm_baseline, variant};
use super::row::Row;
use super::stats::{self, Interval};
use crate::method::{Method, MethodSettings};

/// One way of drawing against a rival: the RBM baseline in the same stage, or a mesh.
#[derive(Clone, Debug, PartialEq)]
pub struct Ratio {
    /// The way, without its size.
    pub settings: MethodSettings,
    /// Time over the rival's: the geometric mean over views and sizes, with its 95 % interval.
    pub time: Interval,
    /// The least and the greatest ratio of a single view and size.
    pub range: (f64, f64),
    /// How many views and sizes.
    pub pictures: usize,
    /// Missed and ghost pixels over the pixels hit, all pictures together.
    pub wrong: f64,
    /// The 99th percentile of the depth error, texels of a 512-row map: the geometric mean over the
    /// pictures, of none less than [`LEAST_DEPTH`]; `None` where nothing was hit.
    pub depth_p99: Option<f64>,
    /// That of the worst picture.
    pub depth_worst: Option<f64>,
    /// The worst root mean square of the normals' angles, degrees.
    pub normal_rms: Option<f64>,
    /// Time above the floor over the rival's whole time: the mean over the pictures of which the
    /// floor is known.
    pub above_floor: Option<f64>,
}

/// Every way's ratio to the RBM baseline, in the order in which the ways first appear. Rows whose
/// clocks disagree count for nothing, and neither do pictures of which the rival has no usable row.
#[must_use]
pub fn over_rbm_baseline(rows: &[Row]) -> Vec<Ratio> {
    let pairs = |way: &MethodSettings| of_way(rows, way, |row| baseline_row(rows, row));
    ways(rows).iter().filter_map(pairs).collect()
}

/// The default search against meshes, over the pictures of which both have a usable row.
#[derive(Clone, Debug, PartialEq)]
pub struct Duel {
    /// The default search in one stage, its errors those in these pictures.
    pub ours: Ratio,
    /// The mesh; `None`: in each picture the coarsest of those measured that errs no more in depth,
    /// pictures without one left out.
    pub mesh: Option<Method>,
    /// The 99th percentile of the mesh's depth error: as [`Ratio::depth_p99`].
    pub mesh_p99: Option<f64>,
    /// In how many of the pictures the mesh errs no more: only there a ratio of times is one of
    /// equals.
    pub no_worse: usize,
}

/// The time of the default search, in each stage, over that of meshes in the fragment stage: of
/// each mesh, then of the coarsest that errs no more.
#[must_use]
pub fn over_meshes(rows: &[Row]) -> Vec<Duel> {
    let all = ways(rows);
    let meshes = || all.iter().map(|w| w.method).filter(|s| s.is_mesh());
    let ours = all.iter().filter(|w| w.method == Method::DEFAULT);
    ours.flat_map(|way| {
        let rivals = meshes().map(Some).chain(meshes().next().map(|_| None));
        rivals.filter_map(|mesh| duel(rows, way, mesh))
    })
    .collect()
}

fn duel(rows: &[Row], way: &MethodSettings, mesh: Option<Method>) -> Option<Duel> {
    let rival = |row: &Row| {
        rows.iter()
            .filter(|r| r.settings.method.is_mesh() && same_picture(r, row) && r.time().is_some())
            .filter(|r| match mesh {
                Some(mesh) => r.settings.method == mesh,
                None => errs_no_more(r, row),
            })
            .min_by_key(|r| r.settings.method.quads())
    };
    let ours = of_way(rows, way, rival)?;
    let own = rows.iter().filter(|r| variant(&r.settings) == *way);
    let pairs: Vec<(&Row, &Row)> = own
        .filter(|r| r.time().is_some())
        .filter_map(|r| Some((rival(r)?, r)))
        .collect();
    Some(Duel {
        ours,
        mesh,
        mesh_p99: typical_depth(pairs.iter().map(|(m, _)| *m)),
        no_worse: pairs.iter().filter(|(m, r)| errs_no_more(m, r)).count(),
    })
}

/// What an error of depth counts for at least, texels: roundings of 32 bits.
pub const LEAST_DEPTH: f64 = 1e-4;

/// The geometric mean of the rows' depth errors.
fn typical_depth<'a>(rows: impl Iterator<Item = &'a Row>) -> Option<f64> {
    let logs: Vec<f64> = rows
        .filter_map(|r| Some(r.errors.depth?.p99.max(LEAST_DEPTH).ln()))
        .collect();
    (!logs.is_empty()).then(|| (logs.iter().sum::<f64>() / logs.len() as f64).exp())
}

/// Whether the depth error of `mesh` (99th percentile) is no more than that of `row`.
fn errs_no_more(mesh: &Row, row: &Row) -> bool {
    let p99 = |r: &Row| r.errors.depth.map(|d| d.p99);
    p99(mesh).zip(p99(row)).is_some_and(|(a, b)| a <= b)
}

/// The ways of drawing, in the order in which they first appear.
fn ways(rows: &[Row]) -> Vec<MethodSettings> {
    let mut ways: Vec<MethodSettings> = Vec::new();
    for row in rows {
        let way = variant(&row.settings);
        if !ways.contains(&way) {
            ways.push(way);
        }
    }
    ways
}

/// A way over the rival that `rival` gives for each of its rows.
fn of_way<'a>(
    rows: &'a [Row],
    way: &MethodSettings,
    rival: impl Fn(&Row) -> Option<&'a Row>,
) -> Option<Ratio> {
    let mut pairs: Vec<(&Row, &Row)> = Vec::new();
    for row in rows
        .iter()
        .filter(|r| variant(&r.settings) == *way && r.time().is_some())
    {
        pairs.extend(rival(row).map(|rival| (row, rival)));
    }
    let first = pairs.first()?;
    let passes = first.0.passes.len();
    let in_pass = |pass: usize| -> Vec<f64> {
        pairs
            .iter()
            .filter_map(|(a, b)| paired(a, b, pass))
            .collect()
    };
    // A pass that was ended early holds fewer pictures and would compare others.
    let all: Vec<Vec<f64>> = (0..passes)
        .map(in_pass)
        .filter(|logs| logs.len() == pairs.len())
        .collect();
    let means: Vec<f64> = all
        .iter()
        .map(|logs| (logs.iter().sum::<f64>() / logs.len() as f64).exp())
        .collect();
    let time = stats::geometric(&means)?;
    let single: Vec<f64> = (0..pairs.len())
        .map(|k| (all.iter().map(|logs| logs[k]).sum::<f64>() / all.len() as f64).exp())
        .collect();
    let sum = |f: fn(&Row) -> usize| pairs.iter().map(|(a, _)| f(a)).sum::<usize>() as f64;
    let worst =
        |f: fn(&Row) -> Option<f64>| pairs.iter().filter_map(|(a, _)| f(a)).reduce(f64::max);
    Some(Ratio {
        settings: *way,
        time,
        range: single
            .iter()
            .fold((f64::INFINITY, 0.0), |(l, h), v| (l.min(*v), h.max(*v))),
        pictures: pairs.len(),
        wrong: sum(|r| r.errors.missed + r.errors.ghost) / sum(|r| r.errors.hits).max(1.0),
        depth_p99: typical_depth(pairs.iter().map(|(a, _)| *a)),
        depth_worst: worst(|r| r.errors.depth.map(|d| d.p99)),
        normal_rms: worst(|r| r.errors.normal.map(|n| n.rms)),
        above_floor: mean(pairs.iter().filter_map(|(row, rival)| {
            let above = above_floor(rows, row)?;
            Some(above / rival.time()?.value)
        })),
    })
}

/// The RBM baseline that shows the same picture in the same stage.
fn baseline_row<'a>(rows: &'a [Row], row: &Row) -> Option<&'a Row> {
    rows.iter().find(|r| {
        is_rbm_baseline(&r.settings)
            && r.view == row.view
            && (r.settings.width, r.settings.height, r.settings.stage)
                == (row.settings.width, row.settings.height, row.settings.stage)
            && r.time().is_some()
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

fn mean(values: impl Iterator<Item = f64>) -> Option<f64> {
    let values: Vec<f64> = values.collect();
    (!values.is_empty()).then(|| values.iter().sum::<f64>() / values.len() as f64)
}

/// Whether two rows show the same view at the same size.
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
    use revmap::settings::DrawStage;

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
        let ratios = over_rbm_baseline(&[ours, theirs]);
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
        let ratio = &over_rbm_baseline(&rows)[0];
        assert!((ratio.time.value - 0.5).abs() < 1e-12);
        assert!((ratio.range.0 - 0.25).abs() < 1e-12 && (ratio.range.1 - 1.0).abs() < 1e-12);
        assert_eq!(ratio.pictures, 2);
        // So are depths, beside the worst.
        for (row, p99) in rows.iter_mut().step_by(2).zip([0.01, 0.04]) {
            row.errors.depth = Some(crate::compare::Spread {
                rms: p99,
                p99,
                max: p99,
            });
        }
        let ratio = &over_rbm_baseline(&rows)[0];
        assert!(ratio.depth_p99.is_some_and(|p| (p - 0.02).abs() < 1e-12));
        assert_eq!(ratio.depth_worst, Some(0.04));
    }

    #[test]
    fn what_cannot_be_trusted_counts_for_nothing() {
        let lies = row(&[&[(Some(0.04), 20.0)]]);
        let fine = papers(row(&[&[(Some(20.0), 20.0)]]));
        let ratios = over_rbm_baseline(&[lies.clone(), fine.clone()]);
        assert_eq!(ratios.len(), 1, "only the RBM baseline itself");
        // A rival that lies leaves nothing to compare with, and another stage or size is no rival.
        assert!(over_rbm_baseline(&[row(&[&[(None, 20.0)]]), papers(lies)]).is_empty());
        let mut compute = row(&[&[(None, 20.0)]]);
        compute.settings.stage = DrawStage::Compute;
        assert_eq!(over_rbm_baseline(&[compute, fine]).len(), 1);
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
        let ratios = over_rbm_baseline(&rows);
        let share = ratios[0].above_floor;
        assert!(share.is_some_and(|s| (s - 0.15).abs() < 1e-12), "{share:?}");
        assert_eq!(ratios[1].above_floor, None);
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
        let time = over_rbm_baseline(&rows)[0].time;
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
        let duels = over_meshes(&rows);
        let told: Vec<_> = duels
            .iter()
            .map(|d| (d.mesh, (d.ours.time.value * 100.0).round(), d.no_worse))
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
        assert!(duels[0].mesh_p99.is_some_and(|p| (p - 0.5).abs() < 1e-12));
        // Without a mesh that errs no more there is no such ratio, and without the default search
        // none at all.
        assert_eq!(over_meshes(&rows[..2]).len(), 1);
        assert!(over_meshes(&rows[1..]).is_empty());
    }
}
