#![allow(clippy::unwrap_used)]
use super::super::view::tests::spindle;
use super::*;
use crate::compare::{CompareOptions, compare};
use crate::method::Method;
use revmap_searches::CIRCLE;

/// A row without errors, timed as told: `(gpu, frame)` in each pass and round.
pub(crate) fn row(passes: &[&[(Option<f64>, f64)]]) -> Row {
    let frame = Frame::new(4, 3, [0.0; 4]).unwrap();
    let errors = compare(&frame, &frame, &CompareOptions::default()).unwrap();
    let case = Case {
        view: 0,
        sweeps: 1,
        settings: MethodSettings {
            method: Method::Search(CIRCLE),
            map_format: revmap::maps::MapFormat::R16,
            ..MethodSettings::default()
        },
    };
    let mut row = Row::new(&spindle(), &case, errors, Steps::of(&frame), 1000);
    let samples = |pass: &&[(Option<f64>, f64)]| {
        pass.iter()
            .map(|&(gpu_ms, frame_ms)| Sample { gpu_ms, frame_ms })
            .collect()
    };
    row.passes = passes.iter().map(samples).collect();
    row
}

#[test]
fn clocks_that_disagree_are_told() {
    let fine = row(&[
        &[(Some(20.0), 21.0), (Some(22.0), 23.0)],
        &[(Some(21.0), 22.0)],
    ]);
    assert_eq!(fine.clocks(), Clocks::Agree);
    assert!((fine.time().unwrap().value - 21.0).abs() < 1e-9);
    // A clock that reads 36 us where 20 ms pass; one that reads too much; the bound itself.
    let lies = row(&[&[(Some(0.036), 20.0)], &[(Some(0.036), 20.0)]]);
    let near = |a: f64, b: f64| (a / b - 1.0).abs() < 1e-12;
    assert!(matches!(
        lies.clocks(),
        Clocks::Disagree { gpu_ms, frame_ms } if near(gpu_ms, 0.036) && near(frame_ms, 20.0)
    ));
    assert_eq!(lies.time(), None);
    assert_eq!(row(&[&[(Some(20.0 * 1.16), 20.0)]]).time(), None);
    assert!(row(&[&[(Some(17.0), 20.0)]]).time().is_some());
    let alone = row(&[&[(None, 20.0)], &[(None, 20.0)]]);
    assert_eq!(
        (alone.clocks(), alone.time().unwrap().value.round()),
        (Clocks::Wall, 20.0)
    );
}

#[test]
fn steps_count_where_the_search_ran() {
    let mut frame = Frame::new(200, 1, [0.0; 4]).unwrap();
    for k in 0..100 {
        frame.steps[k] = (k + 1) as f32;
    }
    frame.exhausted = 7;
    assert_eq!(
        Steps::of(&frame),
        Steps {
            mean: 50.5,
            p99: 99.0,
            max: 100.0,
            exhausted: 7,
        }
    );
}
