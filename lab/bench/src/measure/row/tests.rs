#![allow(clippy::unwrap_used)]
use super::*;
use crate::plan::method::Method;
use crate::plan::rbm_baseline;
use crate::plan::view::tests::spindle;
use revmap::settings::DrawStage;
use revmap_compare::{CompareOptions, Spread, compare};
use revmap_searches::CIRCLE;

/// A row without errors, timed as told: `(gpu, frame)` in each pass and round.
pub(crate) fn row(passes: &[&[(Option<f64>, f64)]]) -> Row {
    let frame = Frame::new(4, 3, [0.0; 4]).unwrap();
    let errors = compare(&frame, &frame, &CompareOptions::default()).unwrap();
    let settings = MethodSettings {
        method: Method::Search(CIRCLE),
        map_format: revmap::maps::MapFormat::R16,
        ..MethodSettings::default()
    };
    let case = Case {
        view: 0,
        sweeps: 1,
        settings,
    };
    let mut row = Row::new(&spindle(), &case, errors, Steps::of(&frame), 1000);
    let samples = |pass: &&[(Option<f64>, f64)]| {
        pass.iter()
            .map(|&(gpu_ms, frame_ms)| Sample {
                gpu_ms,
                frame_ms,
                change_ms: None,
            })
            .collect()
    };
    row.passes = passes.iter().map(samples).collect();
    row
}

/// A row without errors, one frame in each pass, timed by the wall clock.
pub(crate) fn timed(passes: &[f64]) -> Row {
    let passes: Vec<_> = passes.iter().map(|ms| [(None, *ms)]).collect();
    row(&passes.iter().map(|p| p.as_slice()).collect::<Vec<_>>())
}

/// A row of a search in a stage, one frame in each pass, its depths off by so much.
pub(crate) fn drawn(method: Method, stage: DrawStage, passes: &[f64], p99: f64) -> Row {
    let mut row = timed(passes);
    row.settings = MethodSettings::default().by(method).in_stage(stage);
    let (rms, max) = (p99, p99);
    row.errors.depth = Some(Spread { rms, p99, max });
    row
}

impl Row {
    /// The same with other settings.
    pub(crate) fn set(mut self, change: impl FnOnce(&mut MethodSettings)) -> Self {
        change(&mut self.settings);
        self
    }
}

/// The same as the RBM baseline draws it.
pub(crate) fn papers(mut row: Row) -> Row {
    row.settings = rbm_baseline(&spindle(), &row.settings);
    row.source = row.settings.map_source;
    row
}

#[test]
fn clocks_that_disagree_are_told() {
    let first: &[_] = &[(Some(20.0), 21.0), (Some(22.0), 23.0)];
    let fine = row(&[first, &[(Some(21.0), 22.0)]]);
    assert_eq!(fine.clocks(), Clocks::Agree);
    assert!((fine.time().unwrap().value - 21.0).abs() < 1e-9);
    // A clock that reads 36 us where 20 ms pass; one that reads too much; the bound itself.
    let lies = row(&[&[(Some(0.036), 20.0)], &[(Some(0.036), 20.0)]]);
    let Clocks::Disagree { gpu_ms, frame_ms } = lies.clocks() else {
        panic!("{:?}", lies.clocks());
    };
    assert!((gpu_ms / 0.036 - 1.0).abs() < 1e-12 && (frame_ms / 20.0 - 1.0).abs() < 1e-12);
    assert_eq!(lies.time(), None);
    assert_eq!(row(&[&[(Some(20.0 * 1.16), 20.0)]]).time(), None);
    assert!(row(&[&[(Some(17.0), 20.0)]]).time().is_some());
    // A GPU's short frame, of which the wall clock sees submission, too; and one that is too far
    // apart.
    let short = row(&[&[(Some(0.07), 0.2)]]);
    assert_eq!(short.clocks(), Clocks::Agree);
    assert!((short.time().unwrap().value - 0.07).abs() < 1e-12);
    assert_eq!(row(&[&[(Some(0.07), 0.3)]]).time(), None);
    assert_eq!(row(&[&[(Some(0.24), 0.2)]]).time(), None);
    let alone = timed(&[20.0, 20.0]);
    assert_eq!(alone.clocks(), Clocks::Wall);
    assert_eq!(alone.time().unwrap().value.round(), 20.0);
}

#[test]
fn steps_count_where_the_search_ran() {
    let mut frame = Frame::new(200, 1, [0.0; 4]).unwrap();
    for k in 0..100 {
        frame.steps[k] = (k + 1) as f32;
    }
    frame.exhausted = 7;
    let steps = Steps::of(&frame);
    assert_eq!((steps.mean, steps.p99, steps.max), (50.5, 99.0, 100.0));
    assert_eq!(steps.exhausted, 7);
}
