//! Crowds: copies of ten solids by the hundred, the ten thousand and the million, beside one solid
//! seen close, and a flight through them.

mod flight;
mod scenes;

pub use flight::{Flight, fly};
pub use scenes::army;

use super::chapters;
use super::folder::write_text;
use super::machine::Machine;
use super::measure::Measured;
use super::names::{number, percent};
use super::page::Page;
use super::plan::Plan;
use super::ratios;
use super::row::Row;
use super::series_style::SeriesStyles;
use super::stats::Interval;
use super::table::Table;
use super::text;
use crate::method::{Method, MethodSettings};
use revmap::error::Result;
use revmap::settings::{DrawStage, Planes, Tolerance};
use std::path::Path;

/// Numbers of copies.
pub const COPIES: [u32; 3] = [100, 10_000, 1_000_000];
/// How many of them a quick look takes.
pub const QUICK: usize = 2;
/// Copies that are flown through, and in how many frames.
pub const FLOWN: [(u32, usize); 2] = [(10_000, 300), (1_000_000, 30)];
/// The flights of a quick look.
pub const FLOWN_QUICK: [(u32, usize); 1] = [(10_000, 30)];
/// Size of the pictures, pixels.
const SIZE: (u32, u32) = (1366, 706);
/// Most quads of all copies of a mesh: beyond, a frame takes many seconds.
const MOST_QUADS: u64 = 1 << 23;

/// The default search with a tolerance, as crowds are drawn.
#[must_use]
pub fn settings(stage: DrawStage) -> MethodSettings {
    MethodSettings {
        stage,
        width: SIZE.0,
        height: SIZE.1,
        planes: Planes::Color,
        tolerance: Tolerance::DEFAULT,
        ..MethodSettings::default()
    }
}

/// The plan: one solid, then armies of the first `numbers` of [`COPIES`]; the default search exact
/// and with a tolerance, its floor, and meshes.
///
/// # Errors
/// Of the solids that the program carries.
pub fn plan(stages: &[DrawStage], numbers: usize) -> Result<Plan> {
    let mut views = vec![scenes::one()?];
    for &count in COPIES.iter().take(numbers) {
        views.push(scenes::army(count)?);
    }
    let mut plan = Plan::new(views, &[]);
    plan.mixed = true;
    for view in 0..plan.views.len() {
        let solids = plan.views[view].solids() as u64;
        for &stage in stages {
            let own = settings(stage);
            for tolerance in [Tolerance::EXACT, own.tolerance] {
                plan.add(view, MethodSettings { tolerance, ..own });
            }
            plan.add_floor(view, own);
            let meshes = [
                Method::mesh(16, 32)?,
                Method::mesh(64, 128)?,
                Method::MeshLevels,
            ];
            for method in meshes.into_iter().filter(|_| stage == DrawStage::Fragment) {
                if method.quads() * solids <= MOST_QUADS {
                    let tolerance = Tolerance::EXACT;
                    plan.add(
                        view,
                        MethodSettings {
                            method,
                            tolerance,
                            ..own
                        },
                    );
                }
            }
        }
    }
    Ok(plan)
}

/// A row beside the one solid drawn in the same way, the floor beside the one that is searched:
/// time over time, and the same by equal numbers of pixels hit.
fn beside(rows: &[Row], row: &Row) -> Option<(Interval, f64)> {
    let mut like = row.settings;
    if like.method == Method::Floor {
        like.method = Method::DEFAULT;
    }
    let same = |r: &&Row| r.view == 0 && r.settings == like;
    let one = rows.iter().find(same).filter(|_| row.view > 0)?;
    let ratio = ratios::between(row, one)?;
    Some((ratio, one.covered() / row.covered()))
}

fn table(rows: &[Row]) -> Table {
    let header = [
        "scene",
        "solids",
        "method",
        "stage",
        "tolerance (pixels)",
        "pixels hit",
        "time (ms)",
        "time / one solid",
        "by equal pixels",
        "depth p99 (h/512)",
        "wrong pixels",
    ];
    let record = |row: &Row| {
        let beside = beside(rows, row);
        let tolerance = row.settings.tolerance;
        // The floor's picture has no surface to err from.
        let errors = (row.settings.method != Method::Floor).then_some(&row.errors);
        vec![
            row.scene.clone(),
            row.solids.to_string(),
            row.settings.method.to_string(),
            row.settings.stage.name().to_owned(),
            if row.settings.method.follows_tolerance() {
                tolerance.to_string()
            } else {
                String::new()
            },
            percent(row.covered()),
            row.time()
                .map(|t| text::interval(&t, 3))
                .unwrap_or_default(),
            beside
                .as_ref()
                .map(|b| text::interval(&b.0, 2))
                .unwrap_or_default(),
            beside
                .as_ref()
                .map(|b| number(b.0.value * b.1, 2))
                .unwrap_or_default(),
            errors
                .and_then(|e| Some(number(e.depth.as_ref()?.p99, 3)))
                .unwrap_or_default(),
            errors
                .map(|e| (e.missed + e.ghost).to_string())
                .unwrap_or_default(),
        ]
    };
    Table::new(header, rows.iter().map(record).collect())
}

fn flown(flights: &[Flight]) -> Table {
    let header = [
        "solids",
        "stage",
        "frames",
        "median (ms)",
        "of it CPU (ms)",
        "slowest (ms)",
        "slowest / median",
        "pictures compared",
        "error p99.9 (pixels)",
        "farthest contour (pixels)",
    ];
    let record = |flight: &Flight| {
        let ([median, slowest], [p999, contour]) = (flight.frame_ms(), flight.worst());
        vec![
            flight.solids.to_string(),
            flight.settings.stage.name().to_owned(),
            flight.times.len().to_string(),
            number(median, 3),
            number(flight.prepare_ms(), 3),
            number(slowest, 3),
            number(slowest / median, 3),
            flight.errors.len().to_string(),
            number(p999, 3),
            number(contour, 3),
        ]
    };
    Table::new(header, flights.iter().map(record).collect())
}

/// All tables as text.
#[must_use]
pub fn as_text(rows: &[Row], flights: &[Flight]) -> String {
    table(rows).aligned() + "\nFlights:\n" + &flown(flights).aligned()
}

/// Writes `crowds.csv`, a `flight-SOLIDS-STAGE.csv` for each flight, and the page.
///
/// # Errors
/// When a file cannot be written.
pub fn write(
    folder: &Path,
    plan: &Plan,
    measured: &Measured,
    flights: &[Flight],
    machine: &Machine,
) -> Result<()> {
    write_text(&folder.join("crowds.csv"), &table(&measured.rows).csv())?;
    for flight in flights {
        let stage = flight.settings.stage.name();
        let name = format!("flight-{}-{stage}.csv", flight.solids);
        write_text(&folder.join(name), &flight.table().csv())?;
    }
    let mut page = Page::new("revmap: crowds");
    chapters::begin(&mut page, machine, measured);
    page.chapter("Crowds beside one solid");
    page.text(
        "Copies of ten solids stand on a field and are seen from within. One solid is seen close, \
         drawn in the same way; the floor is put beside the solid that is searched. By equal \
         pixels: the ratio of times over the ratio of the pixels hit. The camera stands still: what \
         a moving one costs the CPU is in the flights.",
    );
    page.table(&table(&measured.rows), &[0, 2, 3]);
    page.chapter("Flights");
    page.text(&format!(
        "With the tolerance of {} pixels. A frame is what the CPU takes to cull, list and prepare its copies and the time until it is drawn. Errors are of some \
         of the pictures, against exact ones: as the tolerance's, in pixels.",
        Tolerance::DEFAULT
    ));
    page.table(&flown(flights), &[0, 1]);
    page.chapter("All rows");
    chapters::row_table(&mut page, &measured.rows, &SeriesStyles::of(&measured.rows));
    chapters::end(&mut page, plan, measured);
    write_text(&folder.join("report.html"), &page.html())
}
