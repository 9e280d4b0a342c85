//! The groups of rows that have tables and charts of their own.

use super::columns::Context;
use super::exhibit::{Exhibit, Per};
use super::names::safe;
use super::picture_groups::{Part, parts, pictures_of};
use super::plan::grouped;
use super::row::Row;
use revmap::settings::DrawStage;

/// Rows that have tables and charts of their own, and how these are named.
pub(super) struct Place<'a> {
    /// The rows.
    pub(super) rows: Vec<&'a Row>,
    /// The heading above them.
    pub(super) heading: Option<String>,
    /// The values of the words in braces.
    words: [(&'static str, String); 6],
}

impl Place<'_> {
    /// A text with the values of the words in braces.
    pub(super) fn fill(&self, text: &str) -> String {
        let put = |text: String, (word, value): &(&str, String)| text.replace(word, value);
        self.words.iter().fold(text.to_owned(), put)
    }

    /// The chapter and the heading above the text of an exhibit.
    pub(super) fn above(&self, exhibit: &Exhibit) -> String {
        match (&exhibit.chapter, &self.heading) {
            (Some(chapter), Some(heading)) => format!("{chapter} ({heading})\n\n"),
            (Some(one), None) | (None, Some(one)) => format!("{one}\n\n"),
            (None, None) => String::new(),
        }
    }

    /// What a caption says of rows that no chart of times can hold.
    pub(super) fn untimed(&self) -> String {
        match self.rows.iter().filter(|r| r.time().is_none()).count() {
            0 => String::new(),
            1 => " The clocks of 1 row disagree: it is not in the chart.".to_owned(),
            count => format!(" The clocks of {count} rows disagree: they are not in the chart."),
        }
    }
}

/// The groups of rows that have tables and charts of their own.
pub(super) fn places<'a>(context: &Context, rows: &[&'a Row], per: Per) -> Vec<Place<'a>> {
    let place = |rows: Vec<&'a Row>, heading, part: (&str, String)| {
        let first = rows.first();
        let of = |value: Option<String>| value.unwrap_or_default();
        let words = [
            ("{scene}", of(first.map(|r| safe(&r.scene)))),
            ("{size}", of(first.map(|r| r.size()))),
            (
                "{stage}",
                of(first.map(|r| r.settings.stage.name().to_owned())),
            ),
            ("{views}", part.0.to_owned()),
            ("{part}", part.1),
            ("{baseline}", context.baseline()),
        ];
        Place {
            rows,
            heading,
            words,
        }
    };
    let all = || ("All views", String::new());
    match per {
        Per::Run => vec![place(rows.to_vec(), None, all())],
        Per::Picture => {
            let of = |group: Vec<&'a Row>| place(group, None, all());
            pictures_of(rows).into_iter().map(of).collect()
        }
        Per::Part => {
            let owned: Vec<Row> = rows.iter().map(|r| (*r).clone()).collect();
            let all = parts(&owned);
            let of = |part: &Part| {
                let own = rows
                    .iter()
                    .filter(|r| part.framing.is_none_or(|f| r.framing == f));
                place(
                    own.copied().collect(),
                    Some(part.title()),
                    (part.views(), part.ending(&all)),
                )
            };
            all.iter().map(of).collect()
        }
        Per::Stage => {
            let of = |stage: DrawStage| -> Vec<&'a Row> {
                rows.iter()
                    .filter(|r| r.settings.stage == stage)
                    .copied()
                    .collect()
            };
            let stages = [DrawStage::Fragment, DrawStage::Compute].map(of);
            let own = stages.into_iter().filter(|rows| !rows.is_empty());
            own.map(|rows| place(rows, None, all())).collect()
        }
        Per::Size => {
            let sizes = grouped(rows, |a, b| a.size() == b.size());
            let several = sizes.len() > 1;
            let of = |rows: Vec<&'a Row>| {
                let size = rows.first().map(|r| r.size());
                place(rows, size.filter(|_| several), all())
            };
            sizes.into_iter().map(of).collect()
        }
    }
}
