//! Tables of a report.

use crate::measure::growth::growth;
use crate::measure::ratios::{Over, Ratio, mean_ms, over};
use crate::measure::row::Row;
use crate::plan::method::{Method, MethodSettings};
use crate::report::columns::{self, Cell, Context};
use crate::report::published::published;
use revmap::error::{Error, ErrorKind, Result};
use revmap_figures::groups::grouped;
use revmap_figures::names::{number, range};
use revmap_figures::stats::{self, Interval};
use revmap_figures::table::Table as Text;
use serde::Deserialize;
use serde::de::IntoDeserializer;

/// A table.
#[derive(Clone, Debug, Default, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Table {
    /// The kind of its records.
    pub of: Records,
    /// The heading above it.
    pub heading: String,
    /// Columns, by their names. In tables of ways also `ratio R` (in brackets if not resolved),
    /// `interval R`, `range R`, `faster R` of the time over `R`, `known ms` and `other ms` for the
    /// mean times, `mean C`, `worst C`, `average C` of a column, `other C` of the mesh's,
    /// `pictures`, `total wrong`, `no worse`.
    pub columns: Vec<String>,
    /// In tables of ways, what times are put over.
    pub over: Option<Over>,
    /// The file that holds it, too.
    pub csv: Option<String>,
    /// True if it is printed, too.
    pub print: bool,
    /// In tables of growth, the column that grows; in published ones the number of the table.
    pub x: String,
}

/// Kinds of records.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Records {
    /// Rows.
    #[default]
    Rows,
    /// The first row of each picture.
    Pictures,
    /// Ways of drawing, over all pictures.
    Ways,
    /// Ways of drawing, and how their times grow.
    Growth,
    /// A published table, measured again.
    Published,
    /// Flights.
    Flights,
}

/// What times are put over, by its name in plans.
fn reference(name: &str) -> Result<Over> {
    let read = Over::deserialize(name.into_deserializer());
    read.map_err(|e: serde::de::value::Error| {
        let message = format!("nothing to put times over: {e}");
        Error::new(ErrorKind::Content, message)
    })
}

impl Table {
    pub(super) fn check(&self) -> Result<()> {
        let mut names = self.columns.iter();
        names.try_for_each(|name| heading(name, self.over).map(|_| ()))
    }

    /// The table over these rows, for a page.
    pub fn shown(&self, context: &Context, rows: &[&Row]) -> Result<Text> {
        let over = match self.of {
            Records::Ways => Some(self.over.unwrap_or(Over::Baseline)),
            Records::Rows | Records::Pictures => None,
            Records::Growth => return growth_table(context, rows, &self.x),
            Records::Published => return Ok(published(context, rows, &self.x)),
            Records::Flights => return Ok(Text::default()),
        };
        let mut all = records(rows, over);
        if self.of == Records::Pictures {
            let pictures = grouped(rows, |r| r.picture()).into_iter();
            all = pictures.map(|(_, p)| Record::Row(p[0])).collect();
        }
        let names = &self.columns;
        let header = names.iter().map(|name| heading(name, over));
        let header = header.collect::<Result<Vec<String>>>()?;
        let record = |one: &Record| -> Result<Vec<String>> {
            let shown = |name: &String| Ok(one.cell(context, rows, name)?.shown());
            names.iter().map(shown).collect()
        };
        let records = all.iter().map(record);
        Ok(Text::new(header, records.collect::<Result<_>>()?))
    }
}

/// A record of a table, or a point of a chart.
pub(crate) enum Record<'a> {
    /// A row.
    Row(&'a Row),
    /// A way of drawing over other rows.
    Way(Over, Ratio<'a>),
}

/// A record for each row, or for each way of drawing over other rows.
pub(super) fn records<'a>(rows: &[&'a Row], reference: Option<Over>) -> Vec<Record<'a>> {
    let own = rows.iter().copied();
    match reference {
        None => own.map(Record::Row).collect(),
        Some(other) => {
            let ratios = over(own, other).into_iter();
            ratios.map(|ratio| Record::Way(other, ratio)).collect()
        }
    }
}

impl Record<'_> {
    pub(super) fn settings(&self) -> &MethodSettings {
        match self {
            Self::Row(row) => &row.settings,
            Self::Way(_, ratio) => &ratio.settings,
        }
    }

    /// The time of a row, or the ratio of a way's.
    pub(super) fn time(&self) -> Option<Interval> {
        match self {
            Self::Row(row) => row.time(),
            Self::Way(_, ratio) => Some(ratio.time),
        }
    }

    pub(super) fn cell(&self, context: &Context, rows: &[&Row], name: &str) -> Result<Cell> {
        match self {
            Self::Row(row) => Ok((columns::named(name)?.cell)(context, row)),
            Self::Way(over, ratio) => cell(context, rows, (*over, ratio), name),
        }
    }
}

/// The heading of a column of rows, or of ways.
pub(super) fn heading(name: &str, over: Option<Over>) -> Result<String> {
    let head = |column: &str| columns::named(column).map(|c| c.heading);
    let Some(over) = over else {
        return Ok(head(name)?.to_owned());
    };
    Ok(match name.split_once(' ') {
        Some(("known", "ms")) => "time (ms)".to_owned(),
        Some(("other", "ms")) => "the other time (ms)".to_owned(),
        Some((word @ "faster", _)) => word.to_owned(),
        Some((kind @ ("ratio" | "known" | "interval" | "range"), other)) => {
            match (kind, reference(other)?) {
                ("interval", _) => "95 % interval".to_owned(),
                ("range", _) => "range over pictures".to_owned(),
                (_, Over::Baseline) => "time / RBM baseline".to_owned(),
                (_, Over::Opponent) => format!("time / {}", Method::OPPONENT),
                (_, Over::Equal) => "time / mesh of equal silhouettes".to_owned(),
                _ => format!("time / {}", other.replace('-', " ")),
            }
        }
        Some(("worst", column)) => format!("worst {}", head(column)?),
        Some(("other", column)) => format!("mesh {}", head(column)?),
        Some(("mean" | "average", column)) => head(column)?.to_owned(),
        Some(("no", "worse")) => "mesh at least as accurate".to_owned(),
        Some(("total", "wrong")) => "wrong pixels".to_owned(),
        None if name == "pictures" => name.to_owned(),
        None if name == "pair" => "method / mesh".to_owned(),
        _ if over == Over::Mesh && name == "method" => "method / mesh".to_owned(),
        _ => head(name)?.to_owned(),
    })
}

/// The cell of a way over the rows of a reference.
pub(crate) fn cell(
    context: &Context,
    rows: &[&Row],
    (primary, ratio): (Over, &Ratio),
    name: &str,
) -> Result<Cell> {
    let values = |column: &str, other: bool| -> Result<Vec<f64>> {
        let column = columns::named(column)?;
        let rows = ratio.pairs.iter().map(|p| if other { p.1 } else { p.0 });
        let values = rows.filter_map(|row| (column.cell)(context, row).value());
        Ok(values.map(|v| v.max(column.floor)).collect())
    };
    let mean = |column: &str, other| {
        Ok::<_, Error>(stats::geometric(&values(column, other)?).map(|m| m.value))
    };
    let time = |other: &str| -> Result<Option<(Interval, (f64, f64))>> {
        let wanted = reference(other)?;
        if wanted == primary {
            return Ok(Some((ratio.time, ratio.range)));
        }
        let all = over(rows.iter().copied(), wanted);
        let own = all.iter().find(|r| r.settings == ratio.settings);
        Ok(own.map(|r| (r.time, r.range)))
    };
    let first = ratio.pairs.first().map(|(row, _)| *row);
    let floor = ratio.settings.method == Method::Floor;
    let found = match name.split_once(' ') {
        // It has no surface to err from.
        Some(("mean" | "worst" | "total", _)) if floor => Cell::Empty,
        Some(("range", _)) if ratio.pairs.len() == 1 => Cell::Empty,
        Some(("ratio", other)) => match context.known(time(other)?.map(|t| t.0)) {
            // As in charts.
            Cell::Unresolved(i) => Cell::Text(format!("({})", number(i.value, 3))),
            known => Cell::number(known.value()),
        },
        Some(("known", "ms")) => {
            let own: Vec<&Row> = ratio.pairs.iter().map(|(row, _)| *row).collect();
            context.known(mean_ms(&own))
        }
        Some(("other", "ms")) => {
            let others: Vec<&Row> = ratio.pairs.iter().map(|(_, other)| *other).collect();
            context.known(mean_ms(&others))
        }
        Some(("faster", other)) => time(other)?.map_or(Cell::Empty, |(time, _)| {
            let verdict = time.verdict(context.resolved);
            Cell::text(verdict.word(ratio.settings.stage.name(), other))
        }),
        Some(("known", other)) => context.known(time(other)?.map(|t| t.0)),
        Some(("interval", other)) => {
            time(other)?.map_or(Cell::Empty, |t| Cell::Text(context.ends(&t.0)))
        }
        Some(("range", other)) => time(other)?.map_or(Cell::Empty, |t| Cell::Text(range(t.1))),
        Some(("mean", column)) => Cell::number(mean(column, false)?),
        Some(("other", column)) => Cell::number(mean(column, true)?),
        Some(("worst", column)) => {
            Cell::number(values(column, false)?.into_iter().reduce(f64::max))
        }
        Some(("average", column)) => {
            Cell::number(stats::mean(&values(column, false)?).map(|m| m.value))
        }
        Some(("no", _)) => Cell::Count(ratio.no_worse() as u64),
        Some(("total", _)) => Cell::Share(ratio.wrong()),
        None if name == "pictures" => Cell::Count(ratio.pairs.len() as u64),
        None if name == "pair" => {
            let mesh = ratio.mesh.map(|m| m.to_string());
            let mesh = mesh.unwrap_or("coarsest as accurate".to_owned());
            Cell::Text(format!("{} / {mesh}", context.styles.way(&ratio.settings)))
        }
        _ => {
            let column = columns::named(name)?;
            first.map_or(Cell::Empty, |row| (column.cell)(context, row))
        }
    };
    Ok(found)
}

fn growth_table(context: &Context, rows: &[&Row], x: &str) -> Result<Text> {
    let column = columns::named(x)?;
    let x = |row: &Row| (column.cell)(context, row).value();
    let end = |p: Option<&(f64, f64)>| Cell::number(p.map(|p| p.1)).shown();
    Ok(Text::of(
        &growth(rows, x, context.resolved),
        &[
            ("method", &|g| context.styles.way(&g.way)),
            ("stage", &|g| g.way.stage.name().to_owned()),
            ("resolved", &|g| {
                format!("{} of {}", g.points.len(), g.measured)
            }),
            ("time at the least (ms)", &|g| end(g.points.first())),
            ("time at the most (ms)", &|g| end(g.points.last())),
            ("exponent (95 % interval)", &|g| {
                g.exponent.map_or(Cell::Empty, Cell::Known).shown()
            }),
            ("exponent of the last step", &|g| {
                Cell::number(g.last).shown()
            }),
        ],
    ))
}
