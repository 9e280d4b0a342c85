//! Times in proportion to a rival's, over all views: the table that says which search is faster, and how sure that is.

use super::plan::{is_papers_loop, variant};
use super::row::Row;
use super::stats::{self, Interval};
use crate::settings::{DrawStage, Settings};

/// One way of drawing against the loop of the papers in the same stage.
#[derive(Clone, Debug, PartialEq)]
pub struct Ratio {
    /// The way, without its size.
    pub settings: Settings,
    /// Time over the rival's: the geometric mean over views and sizes, with its 95 % interval.
    pub time: Interval,
    /// The least and the greatest ratio of a single view and size.
    pub range: (f64, f64),
    /// How many views and sizes.
    pub pictures: usize,
    /// Missed and ghost pixels over the pixels hit, all pictures together.
    pub wrong: f64,
    /// The worst 99th percentile of the depth error, texels of a 512-row map; `None` where nothing was hit.
    pub depth_p99: Option<f64>,
    /// The worst root mean square of the normals' angles, degrees.
    pub normal_rms: Option<f64>,
}

/// Every way's ratio to the loop of the papers, in the order in which the ways first appear. Rows whose clocks disagree count for
/// nothing, and neither do pictures of which the rival has no usable row.
#[must_use]
pub fn over_papers_loop(rows: &[Row]) -> Vec<Ratio> {
    let mut ways: Vec<Settings> = Vec::new();
    for row in rows {
        let way = variant(&row.settings);
        if !ways.contains(&way) {
            ways.push(way);
        }
    }
    ways.iter().filter_map(|way| of_way(rows, way)).collect()
}

fn of_way(rows: &[Row], way: &Settings) -> Option<Ratio> {
    let mut pairs: Vec<(&Row, &Row)> = Vec::new();
    for row in rows
        .iter()
        .filter(|r| variant(&r.settings) == *way && r.time().is_some())
    {
        pairs.extend(rival(rows, row).map(|rival| (row, rival)));
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
        depth_p99: worst(|r| r.errors.depth.map(|d| d.p99)),
        normal_rms: worst(|r| r.errors.normal.map(|n| n.rms)),
    })
}

/// The papers' loop that shows the same picture in the same stage. The reference is held against the fragment stage.
fn rival<'a>(rows: &'a [Row], row: &Row) -> Option<&'a Row> {
    let stage = match row.settings.stage {
        DrawStage::Reference => DrawStage::Fragment,
        other => other,
    };
    rows.iter().find(|r| {
        is_papers_loop(&r.settings)
            && r.view == row.view
            && (r.settings.width, r.settings.height, r.settings.stage)
                == (row.settings.width, row.settings.height, stage)
            && r.time().is_some()
    })
}

/// The time of `a` over that of `b`, two rows that were drawn in turn; `None` where a clock cannot be trusted.
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
    use super::super::plan::papers_loop;
    use super::super::row::tests::row;
    use super::super::view::tests::spindle;
    use super::*;

    fn papers(mut row: Row) -> Row {
        row.settings = papers_loop(&spindle(), &row.settings);
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
        let ratios = over_papers_loop(&[ours, theirs]);
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
        let ratio = &over_papers_loop(&rows)[0];
        assert!((ratio.time.value - 0.5).abs() < 1e-12);
        assert!((ratio.range.0 - 0.25).abs() < 1e-12 && (ratio.range.1 - 1.0).abs() < 1e-12);
        assert_eq!(ratio.pictures, 2);
    }

    #[test]
    fn what_cannot_be_trusted_counts_for_nothing() {
        let lies = row(&[&[(Some(0.04), 20.0)]]);
        let fine = papers(row(&[&[(Some(20.0), 20.0)]]));
        let ratios = over_papers_loop(&[lies.clone(), fine.clone()]);
        assert_eq!(ratios.len(), 1, "only the papers' loop itself");
        // A rival that lies leaves nothing to compare with, and another stage or size is no rival.
        assert!(over_papers_loop(&[row(&[&[(None, 20.0)]]), papers(lies)]).is_empty());
        let mut compute = row(&[&[(None, 20.0)]]);
        compute.settings.stage = DrawStage::Compute;
        assert_eq!(over_papers_loop(&[compute, fine]).len(), 1);
    }

    /// A run that was ended in its second pass: the picture that lacks the pass must not shift the mean.
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
        let time = over_papers_loop(&rows)[0].time;
        assert!((time.value - 0.5).abs() < 1e-12 && time.high == f64::INFINITY);
    }
}
