#![allow(clippy::unwrap_used)]
use super::super::row::tests::row;
use super::*;

/// Calls with what the cells of these rows are made from.
pub(crate) fn with_context<T>(rows: &[Row], then: impl FnOnce(&Context) -> T) -> T {
    let mut plan = Plan::new(Vec::new());
    plan.sweeps.push(String::new());
    then(&Context {
        rows,
        plan: &plan,
        styles: SeriesStyles::of(rows),
        device: "dev",
        driver: "drv",
        resolved: 0.25,
    })
}

/// `results.csv` of these rows.
pub(crate) fn csv_of(rows: &[Row], device: &str, driver: &str) -> Table {
    let own: Vec<&Row> = rows.iter().collect();
    with_context(rows, |context| {
        let context = Context {
            device,
            driver,
            styles: context.styles.clone(),
            ..*context
        };
        context.file(&own, &results().collect::<Vec<_>>()).unwrap()
    })
}

fn record(row: &Row) -> Vec<String> {
    csv_of(std::slice::from_ref(row), "dev", "drv")
        .records
        .remove(0)
}

#[test]
fn every_column_is_defined_once_and_explained() {
    for (i, column) in COLUMNS.iter().enumerate() {
        assert!(
            COLUMNS[..i].iter().all(|c| c.name != column.name),
            "{}",
            column.name
        );
        assert!(column.meaning.len() > 5 && !column.heading.is_empty());
    }
    assert_eq!(
        (COLUMNS[CONTRACT - 1].name, COLUMNS[RESULTS - 1].name),
        ("driver", "shadow")
    );
    assert!(named("nothing").is_err());
}

#[test]
fn a_record_has_the_columns_of_the_contract() {
    let fine = record(&row(&[&[
        (Some(20.0), 21.0),
        (Some(30.0), 31.0),
        (Some(10.0), 11.0),
    ]]));
    let at =
        |record: &[String], name: &str| record[results().position(|c| c == name).unwrap()].clone();
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
        ("above_floor_ms", ""),
        ("resolved", "no"),
        ("time_over_fragment", ""),
        ("shadow", "off"),
    ] {
        assert_eq!(at(&fine, column), wanted, "{column}");
    }
    // Several passes give the report's time and interval.
    let passes = row(&[
        &[(Some(20.0), 21.0)],
        &[(Some(22.0), 23.0)],
        &[(Some(21.0), 22.0)],
    ]);
    let (found, time) = (record(&passes), passes.time().unwrap());
    let number = |name: &str| at(&found, name).parse::<f64>().unwrap();
    let median = number("gpu_ms_median");
    assert!((median - time.value).abs() < 1e-3 && (median - 20.98).abs() < 0.01);
    assert!((number("gpu_ms_low") - time.low).abs() < 1e-3);
    assert!((number("gpu_ms_high") - time.high).abs() < 1e-3);
    assert!(time.low < 20.0 && time.high > 22.0);
    assert_eq!(at(&found, "resolved"), "yes");
    let wrong = record(&row(&[&[(Some(0.036), 20.0)]]));
    let told = ["gpu_ms_median", "gpu_ms_p95", "frame_ms_median"].map(|name| at(&wrong, name));
    assert_eq!(told, ["", "", "20"]);
}

/// Times of 8, 4 and 2 ms exact and at two tolerances: ratios, and which errors are within.
#[test]
fn planted_times_and_errors_are_shown() {
    let timed = |ms: f64, tolerance: f64, p999| {
        let mut row = row(&[&[(Some(ms), ms)], &[(Some(ms), ms)]]);
        row.settings = crate::method::MethodSettings {
            tolerance: Tolerance::new(tolerance).unwrap(),
            ..crate::method::MethodSettings::default()
        };
        row.pixel_errors = Some(PixelErrors {
            pixels: 1000,
            p999,
            ..PixelErrors::default()
        });
        row
    };
    let rows = [
        timed(8.0, 0.0, 0.0),
        timed(4.0, 0.25, 0.2),
        timed(2.0, 2.0, 2.5),
    ];
    let all: Vec<&Row> = rows.iter().collect();
    let found = with_context(&rows, |context| {
        context
            .file(&all, &["time_over_exact", "within", "error_p999_px"])
            .unwrap()
    });
    assert_eq!(
        found.records,
        [["1", "", "0"], ["0.5", "yes", "0.2"], ["0.25", "no", "2.5"]]
    );
    let names = [
        "tolerance_px",
        "worst error_p999_px",
        "known exact",
        "pictures",
    ];
    let means = with_context(&rows, |context| {
        super::super::exhibit::ways_table(context, &rows, Over::Exact, &names).unwrap()
    });
    assert_eq!(means.records[2], ["2", "2.5", "0.25 (0.25 to 0.25)", "1"]);
}

/// 5 ms in compute over 10 in the fragment stage, in files with its interval; a value whose
/// interval is too wide says so in tables, and its file has a column for it.
#[test]
fn the_ratio_of_the_stages_and_what_is_not_resolved_are_in_files() {
    let mut rows = [
        row(&[&[(None, 10.0)], &[(None, 11.0)], &[(None, 10.0)]]),
        row(&[&[(None, 5.0)], &[(None, 5.5)], &[(None, 5.0)]]),
        row(&[&[(None, 5.0)], &[(None, 50.0)], &[(None, 5.0)]]),
    ];
    rows[1].settings.stage = revmap::settings::DrawStage::Compute;
    rows[2].settings.max_steps = Some(7);
    let table = csv_of(&rows, "dev", "drv");
    let of = |name: &str| -> Vec<String> {
        let place = table.column(name).unwrap();
        table.records.iter().map(|r| r[place].clone()).collect()
    };
    for name in ["", "_low", "_high"] {
        assert_eq!(of(&format!("time_over_fragment{name}")), ["", "0.5", ""]);
    }
    assert_eq!(of("resolved"), ["yes", "yes", "no"]);
    let all: Vec<&Row> = rows.iter().collect();
    let (page, file) = with_context(&rows, |context| {
        (
            context.page(&all, &["time_interval"]).unwrap(),
            context.file(&all, &["time_interval"]).unwrap(),
        )
    });
    assert!(page.records[2][0].ends_with(", not resolved"), "{page:?}");
    assert_eq!(file.header, ["time_low_ms", "time_high_ms", "resolved"]);
    assert_eq!((&*file.records[1][2], &*file.records[2][2]), ("yes", "no"));
    let wide = Interval {
        value: 1.0,
        low: 0.5,
        high: 2.0,
    };
    let cell = with_context(&rows, |context| context.known(Some(wide)));
    assert_eq!(cell.shown(), "1 (0.5 to 2), not resolved");
}
