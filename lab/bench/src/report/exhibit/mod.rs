//! Tables and charts of a report, described in TOML. The folder `own` holds the program's. A plan
//! may add some. Each names columns; see [`columns`](crate::report::columns).

mod answers;
mod charts;
mod guides;
pub(crate) mod places;
mod tables;

pub use answers::Question;
pub(crate) use answers::{findings, unresolved};
pub use charts::Chart;
pub(crate) use tables::cell;
pub use tables::{Records, Table};

use crate::measure::row::Row;
use crate::report::columns::Context;
use revmap::error::{Error, ErrorKind, Result};

/// Tables and charts on one question.
#[derive(Clone, Debug, serde::Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Exhibit {
    /// Its name, by which plans choose it.
    pub name: String,
    /// The chapter that it begins; none: it belongs to the one before.
    pub chapter: Option<String>,
    /// Paragraphs before the tables and charts.
    #[serde(default)]
    pub text: Vec<String>,
    /// The question that it answers before them, in a sentence from the rows.
    pub question: Option<Question>,
    /// The groups of rows that have tables and charts of their own.
    #[serde(default)]
    pub per: Per,
    /// Names of the plan's entries whose rows count; none: all.
    #[serde(default)]
    pub only: Vec<String>,
    /// Names of entries whose rows do not count, unless another entry holds them.
    #[serde(default)]
    pub except: Vec<String>,
    /// The charts.
    #[serde(default)]
    pub chart: Vec<Chart>,
    /// The tables.
    #[serde(default)]
    pub table: Vec<Table>,
}

/// The groups of rows that have tables and charts of their own.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, serde::Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Per {
    /// All rows together.
    #[default]
    Run,
    /// All rows, then those of each framing.
    Part,
    /// A view at a size.
    Picture,
    /// Each stage.
    Stage,
    /// Each size of pictures.
    Size,
}

/// The program's own exhibits.
#[derive(serde::Deserialize)]
struct File {
    exhibit: Vec<Exhibit>,
}

/// The files of the program's own exhibits.
const OWN: [&str; 3] = [
    include_str!("own/times.toml"),
    include_str!("own/accuracy.toml"),
    include_str!("own/plans.toml"),
];

/// The program's own exhibits, then `more`.
pub fn all(more: &[Exhibit]) -> Result<Vec<Exhibit>> {
    let mut all = more.to_vec();
    for text in OWN {
        let own: File = toml::from_str(text)
            .map_err(|e| Error::new(ErrorKind::Other, format!("exhibits: {e}; report this")))?;
        // A plan's exhibit takes the place of the program's of the same name.
        let kept = |own: &Exhibit| !more.iter().any(|m| m.name == own.name);
        all.extend(own.exhibit.into_iter().filter(kept));
    }
    Ok(all)
}

impl Exhibit {
    /// Checks names of columns and of the plan's entries.
    pub fn check(&self, sweeps: &[&str]) -> Result<()> {
        let at = |e: Error| e.at_key(format!("exhibit {}", self.name));
        for name in self.only.iter().chain(&self.except) {
            if !sweeps.contains(&name.as_str()) {
                let all = sweeps.join(", ");
                let message = format!("{name:?} is no name of a [[measure]]; give one of {all}");
                return Err(at(Error::new(ErrorKind::Content, message)));
            }
        }
        self.chart.iter().try_for_each(Chart::check).map_err(at)?;
        self.table.iter().try_for_each(Table::check).map_err(at)
    }

    pub(super) fn answers(&self, context: &Context, rows: &[&Row]) -> Vec<String> {
        let answers = |q: Question| q.answers(context, rows);
        self.question.map(answers).unwrap_or_default()
    }

    /// The rows that count.
    pub(super) fn rows<'a>(&self, context: &Context<'a>) -> Vec<&'a Row> {
        let bits = |names: &[String]| -> u64 {
            let all = context.plan.sweeps.iter().enumerate();
            let own = all.filter(|(_, sweep)| names.contains(sweep));
            own.fold(0, |bits, (place, _)| bits | 1 << place.min(63))
        };
        let (only, except) = (bits(&self.only), bits(&self.except));
        let counts = |row: &&Row| {
            (self.only.is_empty() || row.sweeps & only != 0) && row.sweeps & !except != 0
        };
        context.rows.iter().copied().filter(counts).collect()
    }
}
