//! The tables that sum a run up, and what their fields look like.

use super::names::{number, percent};
use super::picture_groups::{parts, pictures};
use super::plan::{Labels, RBM_BASELINE};
use super::ratios::{Duel, Ratio, over_meshes, over_rbm_baseline};
use super::row::Row;
use super::stats::Interval;
use super::table::Table;

/// An interval as `0.42 (0.40 to 0.44)`; only the value where a single observation says nothing
/// about spread.
#[must_use]
pub fn interval(i: &Interval, digits: usize) -> String {
    if i.high.is_finite() {
        format!(
            "{} ({} to {})",
            number(i.value, digits),
            number(i.low, digits),
            number(i.high, digits)
        )
    } else {
        number(i.value, digits)
    }
}

/// Columns of the table of times over the RBM baseline's.
pub const RATIOS: [&str; 11] = [
    "method",
    "stage",
    "time / RBM baseline",
    "95 % interval",
    "range over pictures",
    "pictures",
    "wrong pixels",
    "depth p99 (h/512)",
    "worst depth p99 (h/512)",
    "worst normal rms (°)",
    "above the floor / RBM baseline",
];

/// Times over the RBM baseline's.
#[must_use]
pub fn ratio_table(ratios: &[Ratio], labels: &Labels) -> Table {
    let record = |r: &Ratio| {
        vec![
            labels.way(&r.settings),
            r.settings.stage.name().to_owned(),
            number(r.time.value, 3),
            ends(&r.time),
            range(r.range),
            r.pictures.to_string(),
            percent(r.wrong),
            maybe(r.depth_p99),
            maybe(r.depth_worst),
            maybe(r.normal_rms),
            maybe(r.above_floor),
        ]
    };
    Table::new(RATIOS, ratios.iter().map(record).collect())
}

/// The table of ratios, headed.
#[must_use]
pub fn ratios(rows: &[Row]) -> String {
    let labels = Labels::new(rows.iter().map(|r| &r.settings));
    let table = ratio_table(&over_rbm_baseline(rows), &labels);
    if table.records.is_empty() {
        return format!("no ratios: no usable row of the {RBM_BASELINE}\n");
    }
    table.aligned()
}

fn range((least, most): (f64, f64)) -> String {
    format!("{} to {}", number(least, 3), number(most, 3))
}

fn maybe(value: Option<f64>) -> String {
    value.map(|v| number(v, 3)).unwrap_or_default()
}

/// An interval's ends, as `0.40 to 0.44`.
#[must_use]
pub fn ends(i: &Interval) -> String {
    if i.high.is_finite() {
        format!("{} to {}", number(i.low, 3), number(i.high, 3))
    } else {
        "unknown".to_owned()
    }
}

/// Columns of the table of the default search against meshes.
pub const AGAINST_MESHES: [&str; 9] = [
    "method / mesh",
    "stage",
    "time / mesh",
    "95 % interval",
    "range over pictures",
    "pictures",
    "depth p99 (h/512)",
    "mesh depth p99 (h/512)",
    "mesh at least as accurate",
];

/// The default search in each stage over each mesh, then over the coarsest that is at least as
/// accurate; none without both.
#[must_use]
pub fn against_meshes(rows: &[Row]) -> Table {
    let record = |duel: Duel| {
        let ours = &duel.ours;
        let mesh = duel
            .mesh
            .map_or("coarsest as accurate".into(), |m| m.to_string());
        vec![
            format!("{} / {mesh}", ours.settings.method),
            ours.settings.stage.name().to_owned(),
            number(ours.time.value, 3),
            ends(&ours.time),
            range(ours.range),
            ours.pictures.to_string(),
            maybe(ours.depth_p99),
            maybe(duel.mesh_p99),
            duel.no_worse.to_string(),
        ]
    };
    Table::new(
        AGAINST_MESHES,
        over_meshes(rows).into_iter().map(record).collect(),
    )
}

/// The tables that sum a run up: over the RBM baseline, and over meshes where there are any, of all
/// pictures and of each framing; then the pictures themselves.
#[must_use]
pub fn summary(rows: &[Row]) -> String {
    let mut out = String::new();
    for part in parts(rows) {
        out += &format!("{}\n\n{}\n", part.title(), ratios(&part.rows));
        let against = against_meshes(&part.rows);
        if !against.records.is_empty() {
            out += &against.aligned();
            out.push('\n');
        }
    }
    out + &pictures(rows).aligned()
}
