#![allow(clippy::unwrap_used)]
use super::super::tests::folder_of;
use super::*;
use crate::measure::ratios::{Over, over};
use crate::measure::row::Row;
use crate::measure::row::tests::{papers, row};

/// Two pictures by the default search, which takes `part` of the baseline's time, and by the
/// baseline; with so many wrong pixels of the search.
fn rows(part: f64, wrong: usize) -> Vec<Row> {
    let drift = [1.0, 1.3, 0.9];
    let of = |ms: f64, bent: f64| {
        let passes = drift.map(|d| [(None, ms * d), (None, ms * d * bent), (None, ms * d / bent)]);
        row(&passes.each_ref().map(|p| p.as_slice()))
    };
    let pictures = ["vase", "pawn"].into_iter().enumerate();
    let both = pictures.flat_map(|(view, scene)| {
        let ms = 10.0 * (view + 1) as f64;
        let (mut ours, papers) = (of(part * ms, 1.01), papers(of(ms, 1.02)));
        ours.settings.method = Method::DEFAULT;
        ours.errors.missed = wrong;
        [ours, papers].map(|row| Row {
            view,
            scene: scene.to_owned(),
            ..row
        })
    });
    both.collect()
}

/// What a new run says about the claims of a kept one, without those that it repeats.
fn unlike(kept: &[Row], new: &[Row]) -> Vec<(Verdict, String)> {
    let (kept, new) = (folder_of(kept, "dev", "drv"), folder_of(new, "dev", "drv"));
    let methods = ["exact", "baseline"].map(str::to_owned);
    let (claims, _) = claims(kept.path(), new.path(), &methods).unwrap();
    let unlike = claims.into_iter().filter(|c| c.0 != Verdict::Repeated);
    unlike.collect()
}

/// The same rows under names with this ending.
fn ending(rows: Vec<Row>, ending: &str) -> Vec<Row> {
    let named = |row: Row| Row {
        scene: format!("{}{ending}", row.scene),
        ..row
    };
    rows.into_iter().map(named).collect()
}

/// Figures as the table of a report has them, from the files alone.
#[test]
fn ratios_are_those_of_the_report() {
    let rows = rows(0.5, 0);
    let runs = [Run::load(folder_of(&rows, "dev", "drv").path()).unwrap()];
    let by = |run: &Run, record: &[String]| vec![groups::method(run, record)];
    let groups = groups::groups(&runs, &[Scenes::default()], &by);
    let wanted = over(&rows, Over::Baseline);
    let found = stats::over_pictures(&groups[0].times(&runs, true).values[0]);
    let (a, b) = (found.unwrap(), wanted[0].time);
    for (a, b) in [(a.value, b.value), (a.low, b.low), (a.high, b.high)] {
        assert!((a / b - 1.0).abs() < 1e-5, "{a} {b}");
    }
    assert_eq!((groups.len(), groups[0].pictures.len()), (2, 2));
}

#[test]
fn a_changed_figure_is_not_repeated() {
    let kept = rows(0.5, 100);
    assert_eq!(unlike(&kept, &kept), []);
    // Another machine, within what machines differ by.
    assert_eq!(unlike(&kept, &rows(0.6, 105)), []);
    for (new, wanted) in [
        (rows(0.7, 100), "exact, fragment: takes 0.7"),
        (rows(0.35, 100), "exact, fragment: takes 0.35"),
        (
            rows(0.5, 130),
            "exact, fragment: 260 wrong pixels in 2 of the kept run's 2 pictures; kept 200",
        ),
        (rows(0.5, 70), "exact, fragment: 140 wrong pixels"),
    ] {
        let found = unlike(&kept, &new);
        assert_eq!(found.len(), 1, "{found:?}");
        assert_eq!(found[0].0, Verdict::NotRepeated);
        assert!(found[0].1.starts_with(wanted), "{found:?}");
    }
}

/// Pictures that only one run has count neither in the kept figure nor in the new one.
#[test]
fn claims_are_judged_by_the_pictures_of_both_runs() {
    let kept = rows(0.5, 100);
    // A suite that has grown, by pictures with other figures.
    let more = [kept.clone(), ending(rows(0.9, 7), ":more")].concat();
    assert_eq!(unlike(&kept, &more), []);
    // One of two pictures is there, which is enough, and it contradicts.
    assert_eq!(unlike(&kept, &kept[..2]), []);
    let (verdict, text) = unlike(&kept, &rows(0.5, 130)[..2]).remove(0);
    assert_eq!(verdict, Verdict::NotRepeated);
    let wanted = "130 wrong pixels in 1 of the kept run's 2 pictures; kept 100, within 13";
    assert!(text.contains(wanted), "{text}");
    // One of four is not.
    let (verdict, text) = unlike(&more, &kept[..2]).remove(0);
    assert_eq!(verdict, Verdict::NotJudged);
    let wanted = "times in 1 of the kept run's 4 pictures, below half of them";
    assert!(text.contains(wanted), "{text}");
    // No picture in common.
    let found = unlike(&kept, &ending(kept.clone(), ":other"));
    assert_eq!(found.len(), 3, "{found:?}");
    assert!(found.iter().all(|f| f.0 == Verdict::NotJudged), "{found:?}");
}

/// A method is judged by its other pictures where a clock was rejected, where the baseline does not
/// draw a picture, and where the kept run lacks both.
#[test]
fn pictures_without_a_ratio_leave_the_others() {
    let lies = |rows: &mut Vec<Row>| {
        let samples = rows[0].passes.iter_mut().flatten();
        samples.for_each(|s| s.gpu_ms = Some(0.001));
    };
    let kept = [rows(0.5, 100), ending(rows(0.5, 100), ":close")].concat();
    let mut rejected = kept.clone();
    lies(&mut rejected);
    assert_eq!(unlike(&kept, &rejected), []);
    let mut lacking = kept.clone();
    lacking.remove(1);
    assert_eq!(unlike(&kept, &lacking), []);
    assert_eq!(unlike(&lacking, &kept), []);
    // An interval that holds everything says nothing; one that is elsewhere contradicts.
    let with_passes = |factors: [f64; 3]| {
        let mut rows = rows(0.5, 100);
        for (pass, factor) in rows[0].passes.iter_mut().zip(factors) {
            pass.iter_mut().for_each(|s| s.frame_ms *= factor);
        }
        unlike(&kept[..4], &rows)
    };
    let vague = with_passes([0.3, 1.0, 3.0]);
    assert!(
        matches!(&*vague, [(Verdict::NotJudged, text)] if text.contains("wider than 25 %")),
        "{vague:?}"
    );
    let elsewhere = with_passes([30.0, 50.0, 80.0]);
    assert!(
        matches!(&*elsewhere, [(Verdict::NotRepeated, _)]),
        "{elsewhere:?}"
    );
}

#[test]
fn what_the_kept_run_lacks_is_no_claim() {
    let kept = folder_of(&rows(0.5, 0), "dev", "drv");
    let error = claims(kept.path(), kept.path(), &["live".to_owned()]).unwrap_err();
    assert!(error.to_string().contains("holds no live"), "{error}");
}
