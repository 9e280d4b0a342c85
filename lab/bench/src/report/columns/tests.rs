#![allow(clippy::unwrap_used)]
use super::*;
use crate::measure::row::tests::{row, timed};
use crate::report::exhibit::{Records, Table as Exhibited};

/// Calls with what the cells of these rows are made from.
pub(crate) fn with_context<T>(rows: &[Row], then: impl FnOnce(&Context) -> T) -> T {
    let mut plan = Plan::new(Vec::new());
    plan.sweeps.push(String::new());
    let machine = Machine::here("dev", "", "drv", "", "");
    let rows: Vec<&Row> = rows.iter().collect();
    then(&Context::new(&rows, &plan, &machine, 0.25))
}

/// The table of ways over the exact picture.
fn over_exact(context: &Context, names: &[&str]) -> Table {
    let table = Exhibited {
        of: Records::Ways,
        over: Some(Over::Exact),
        columns: names.iter().map(ToString::to_string).collect(),
        ..Exhibited::default()
    };
    table.shown(context, context.rows).unwrap()
}

/// `results.csv` of these rows.
pub(crate) fn csv_of(rows: &[Row], device: &str, driver: &str) -> Table {
    with_context(rows, |context| {
        let context = Context {
            device,
            driver,
            styles: context.styles.clone(),
            ..*context
        };
        let names: Vec<&str> = results().collect();
        context.file(context.rows, &names).unwrap()
    })
}

fn record(row: &Row) -> Vec<String> {
    let mut table = csv_of(std::slice::from_ref(row), "dev", "drv");
    table.records.remove(0)
}

#[test]
fn every_column_is_defined_once_and_explained() {
    for (i, column) in COLUMNS.iter().enumerate() {
        let name = column.name;
        assert!(COLUMNS[..i].iter().all(|c| c.name != name), "{name}");
        assert!(column.meaning.len() > 5 && !column.heading.is_empty());
    }
    assert_eq!(
        (COLUMNS[CONTRACT - 1].name, COLUMNS[RESULTS - 1].name),
        ("driver", "change_ms")
    );
    assert!(named("nothing").is_err());
}

#[test]
fn a_record_has_the_columns_of_the_contract() {
    let frames = [20.0, 30.0, 10.0].map(|ms| (Some(ms), ms + 1.0));
    let fine = record(&row(&[&frames]));
    let at = |record: &[String], name: &str| {
        let place = results().position(|c| c == name);
        record[place.unwrap()].clone()
    };
    let wanted = "scene=spindle technique=revolution extend=0 chamfer=1 stage=fragment \
        solver=circle max_steps=20 width=800 map_rows=512 map_source=exact map_format=r16 \
        objects=1 gpu_ms_median=20 gpu_ms_p95=30 frame_ms_median=21 fps=47.619 missed=0 \
        depth_rms_texels= flip=0 device=dev driver=drv gpu_ms_low= gpu_ms_high= tolerance_px= \
        above_floor_ms= resolved=no time_over_fragment= shadow=off \
        silhouette_p999_px= change_ms=";
    for word in wanted.split_whitespace() {
        let (column, wanted) = word.split_once('=').unwrap();
        assert_eq!(at(&fine, column), wanted, "{column}");
    }
    // Several passes give the report's time and interval.
    let passes = [20.0, 22.0, 21.0].map(|ms| [(Some(ms), ms + 1.0)]);
    let passes = row(&passes.each_ref().map(|p| p.as_slice()));
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
        row.settings = crate::plan::method::MethodSettings::default();
        row.settings.tolerance = Tolerance::new(tolerance).unwrap();
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
    let columns = ["time_over_exact", "within", "error_p999_px"];
    let means = "tolerance_px,worst error_p999_px,known exact,pictures";
    let means: Vec<&str> = means.split(',').collect();
    let (found, means) = with_context(&rows, |context| {
        let file = context.file(context.rows, &columns).unwrap();
        (file, over_exact(context, &means))
    });
    let wanted = [["1", "", "0"], ["0.5", "yes", "0.2"], ["0.25", "no", "2.5"]];
    assert_eq!(found.records, wanted);
    assert_eq!(means.records[2], ["2", "2.5", "0.25 (0.25 to 0.25)", "1"]);
}

#[test]
fn a_ratio_that_is_not_resolved_is_in_brackets() {
    let passes = [[10.0, 10.1, 10.0], [5.0, 5.1, 5.0], [5.0, 50.0, 5.0]];
    let mut rows = passes.map(|passes| timed(&passes));
    for (row, tolerance) in rows.iter_mut().zip([0.0, 0.5, 1.0]) {
        row.settings = crate::plan::method::MethodSettings::default();
        row.settings.tolerance = Tolerance::new(tolerance).unwrap();
    }
    let table = with_context(&rows, |context| over_exact(context, &["ratio exact"]));
    let shown: Vec<&str> = table.records.iter().map(|r| r[0].as_str()).collect();
    assert_eq!(shown, ["1", "0.502", "(1.07)"]);
}

/// 5 ms in compute over 10 in the fragment stage, in files with its interval; a value whose
/// interval is too wide says so in tables, and its file has a column for it.
#[test]
fn the_ratio_of_the_stages_and_what_is_not_resolved_are_in_files() {
    let passes = [[10.0, 11.0, 10.0], [5.0, 5.5, 5.0], [5.0, 50.0, 5.0]];
    let mut rows = passes.map(|passes| timed(&passes));
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
    let (page, file) = with_context(&rows, |context| {
        let page = context.page(context.rows, &["time_interval"]);
        let file = context.file(context.rows, &["time_interval"]);
        (page.unwrap(), file.unwrap())
    });
    assert!(page.records[2][0].ends_with(", not resolved"), "{page:?}");
    assert_eq!(file.header, ["time_low_ms", "time_high_ms", "resolved"]);
    assert_eq!((&*file.records[1][2], &*file.records[2][2]), ("yes", "no"));
    let wide = Some(Interval::new(1.0, 0.5, 2.0));
    let cell = with_context(&rows, |context| context.known(wide));
    assert_eq!(cell.shown(), "1 (0.5 to 2), not resolved");
}
