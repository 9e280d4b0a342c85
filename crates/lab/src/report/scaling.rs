//! How time grows: with pixels, with solids, with rows of the map; each with the exponent of a
//! power law.

mod growth;
mod ranges;

pub use growth::{Growth, growth, value};
pub(crate) use ranges::field;
pub use ranges::{MESHES, Ranges, plan};

use super::chapters;
use super::chart::Figure;
use super::chart::axis::Axis;
use super::chart::xy::{Guide, Point, Series, XyChart};
use super::folder::{keep_figure, write_text};
use super::machine::Machine;
use super::measure::Measured;
use super::names::number;
use super::page::Page;
use super::plan::{Plan, variant};
use super::row::Row;
use super::series_style::SeriesStyles;
use super::table::Table;
use super::text;
use crate::method::MethodSettings;
use revmap::error::Result;
use std::path::Path;

/// What is varied.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Quantity {
    /// Pixels of the picture.
    Pixels,
    /// Copies of a solid.
    Solids,
    /// Rows of the shape map.
    Rows,
}

impl Quantity {
    /// All.
    pub const ALL: [Self; 3] = [Self::Pixels, Self::Solids, Self::Rows];

    /// Its name.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Pixels => "pixels",
            Self::Solids => "solids",
            Self::Rows => "rows of the map",
        }
    }

    /// What stays the same while it grows.
    fn setting(self) -> &'static str {
        match self {
            Self::Pixels => {
                "One solid that fills nine tenths of the picture's height, in pictures of growing size."
            }
            Self::Solids => {
                "A square field of copies at 800x600, seen from above so that the field always fills the picture: the pixels covered stay about the same while the copies grow smaller \
                 and more. Meshes keep their tessellation, and are drawn as long as all copies together have at most 8 million quads."
            }
            Self::Rows => {
                "One solid at 800x600, its map of more and more rows; searches that read no map are not in it."
            }
        }
    }
}

fn table(all: &[Growth], styles: &SeriesStyles) -> Table {
    let record = |g: &Growth| {
        let ends = |k: Option<&(f64, f64)>| k.map(|p| number(p.1, 3)).unwrap_or_default();
        vec![
            styles.way(&g.way),
            g.way.stage.name().to_owned(),
            ends(g.points.first()),
            ends(g.points.last()),
            g.exponent
                .map(|e| text::interval(&e, 2))
                .unwrap_or_else(|| "–".into()),
            g.last.map(|e| number(e, 2)).unwrap_or_else(|| "–".into()),
        ]
    };
    Table::new(HEADER, all.iter().map(record).collect())
}

/// Columns of the table of growth.
pub(super) const HEADER: [&str; 6] = [
    "method",
    "stage",
    "time at the least (ms)",
    "time at the most (ms)",
    "exponent (95 % interval)",
    "exponent of the last step",
];

/// The exponents as text.
#[must_use]
pub fn as_text(rows: &[Row]) -> String {
    let styles = styles(rows);
    let mut out = String::new();
    for quantity in Quantity::ALL {
        let all = growth(rows, quantity);
        if all.is_empty() {
            continue;
        }
        out += &format!(
            "Time with {}: time = factor x {} ^ exponent\n",
            quantity.name(),
            quantity.name()
        );
        out += &table(&all, &styles).aligned();
        out.push('\n');
    }
    out
}

fn styles(rows: &[Row]) -> SeriesStyles {
    let ways: Vec<MethodSettings> = rows
        .iter()
        .map(|r| MethodSettings {
            map_rows: None,
            ..variant(&r.settings)
        })
        .collect();
    SeriesStyles::new(&ways)
}

/// What tells meshes apart, which look alike.
fn fineness(way: &MethodSettings) -> Option<String> {
    let name = way.method.to_string();
    name.strip_prefix("mesh:").map(str::to_owned)
}

fn chart(all: &[Growth], quantity: Quantity, styles: &SeriesStyles) -> Figure {
    let (unit, label) = match quantity {
        Quantity::Pixels => (1e6, "pixels (millions)"),
        Quantity::Solids => (1.0, "solids (number)"),
        Quantity::Rows => (1.0, "rows of the map (number)"),
    };
    let series = all
        .iter()
        .map(|g| Series {
            name: styles.way(&g.way),
            style: styles.style(&g.way),
            points: (g.points.iter().enumerate())
                .map(|(k, &(x, y))| Point {
                    x: x / unit,
                    y,
                    spread: None,
                    label: fineness(&g.way).filter(|_| k + 1 == g.points.len()),
                })
                .collect(),
            joined: false,
        })
        .collect();
    let guides = all
        .iter()
        .filter_map(|g| {
            let law = g.law?;
            let ends = [g.points.first()?, g.points.last()?];
            Some(Guide {
                name: String::new(),
                points: ends.map(|p| (p.0 / unit, law.at(p.0))).to_vec(),
                color: styles.style(&g.way).color,
                dash: styles.style(&g.way).dash,
                width: styles.style(&g.way).line(),
            })
        })
        .collect();
    let ticks = match quantity {
        Quantity::Rows => all.iter().flat_map(|g| &g.points).map(|p| p.0).collect(),
        Quantity::Pixels | Quantity::Solids => Vec::new(),
    };
    XyChart {
        title: format!("Time of a frame with {}", quantity.name()),
        x: Axis::log(label).at(ticks),
        y: Axis::log("time of a frame (ms)"),
        series,
        guides,
    }
    .figure()
}

/// Writes the page of growth.
///
/// # Errors
/// When a file cannot be written.
pub fn write(folder: &Path, plan: &Plan, measured: &Measured, machine: &Machine) -> Result<()> {
    let rows = &measured.rows;
    let styles = styles(rows);
    let mut page = Page::new("revmap: how time grows");
    chapters::begin(&mut page, machine, measured);
    for quantity in Quantity::ALL {
        let all = growth(rows, quantity);
        if all.is_empty() {
            continue;
        }
        page.chapter(&format!("With {}", quantity.name()));
        page.text(quantity.setting());
        let figure = chart(&all, quantity, &styles);
        keep_figure(
            folder,
            &format!("scaling-{}", quantity.name().replace(' ', "-")),
            &figure,
        )?;
        page.figure(
            &figure,
            "Markers are measured times, filled in the fragment stage and hollow in the compute stage; lines are the power laws fitted to them, thinner in the compute stage.",
        );
        page.table(&table(&all, &styles), &[0, 1]);
    }
    page.chapter("All rows");
    // Here the rows of maps tell rows apart.
    chapters::row_table(&mut page, rows, &SeriesStyles::of(rows));
    chapters::end(&mut page, plan, measured);
    write_text(&folder.join("report.html"), &page.html())
}
