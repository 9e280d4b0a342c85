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
fn a_record_has_the_columns_of_the_contract() {
    let fine = row(&[&[(Some(20.0), 21.0), (Some(30.0), 31.0), (Some(10.0), 11.0)]]);
    let record = fine.record("dev", "drv", Some(1.5));
    assert_eq!(record.len(), COLUMNS.len());
    let at = |name: &str| &record[COLUMNS.iter().position(|c| *c == name).unwrap()];
    for (column, wanted) in [
        ("scene", "spindle"),
        ("technique", "revolution"),
        ("extend", "0"),
        ("chamfer", "1"),
        ("stage", "fragment"),
        ("solver", "circle"),
        ("max_steps", "20"),
        ("width", "800"),
        ("map_rows", "512"),
        ("map_source", "exact"),
        ("map_format", "r16"),
        ("objects", "1"),
        ("gpu_ms_median", "20"),
        ("gpu_ms_p95", "30"),
        ("frame_ms_median", "21"),
        ("fps", "47.619"),
        ("missed", "0"),
        ("depth_rms_texels", ""),
        ("flip", "0"),
        ("device", "dev"),
        ("driver", "drv"),
        ("gpu_ms_low", ""),
        ("gpu_ms_high", ""),
        ("tolerance_px", ""),
        ("above_floor_ms", "1.5"),
    ] {
        assert_eq!(at(column), wanted, "{column}");
    }
    // Of several passes: the report's time and interval.
    let passes = row(&[
        &[(Some(20.0), 21.0)],
        &[(Some(22.0), 23.0)],
        &[(Some(21.0), 22.0)],
    ]);
    let (record, time) = (
        passes.record("dev", "drv", Some(1.5)),
        passes.time().unwrap(),
    );
    let number = |k: usize| record[k].parse::<f64>().unwrap();
    assert!((number(14) - time.value).abs() < 1e-3 && (number(14) - 20.98).abs() < 0.01);
    assert!((number(31) - time.low).abs() < 1e-3 && (number(32) - time.high).abs() < 1e-3);
    assert!(time.low < 20.0 && time.high > 22.0);
    let lies = row(&[&[(Some(0.036), 20.0)]]).record("dev", "drv", Some(1.5));
    assert_eq!(
        (lies[14].as_str(), lies[15].as_str(), lies[16].as_str()),
        ("", "", "20")
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
