//! The groups of rows that have tables and charts of their own.

use crate::measure::row::Row;
use crate::plan::view::Framing;
use crate::report::columns::Context;
use crate::report::exhibit::{Exhibit, Per};
use revmap::settings::DrawStage;
use revmap_figures::groups::grouped;
use revmap_figures::names::{count, number, percent, safe};

/// Rows that have tables and charts of their own, and how these are named.
pub(crate) struct Place<'a> {
    pub(crate) rows: Vec<&'a Row>,
    /// The heading above them.
    pub(crate) heading: Option<String>,
    /// The values of the words in braces.
    words: [(&'static str, String); 6],
}

impl<'a> Place<'a> {
    fn new(
        context: &Context,
        rows: Vec<&'a Row>,
        heading: Option<String>,
        (views, part): (&str, &str),
    ) -> Self {
        let of = |value: fn(&Row) -> String| rows.first().map(|r| value(r)).unwrap_or_default();
        let words = [
            ("{scene}", of(|r| safe(&r.scene))),
            ("{size}", of(Row::size)),
            ("{stage}", of(|r| r.settings.stage.name().to_owned())),
            ("{views}", views.to_owned()),
            ("{part}", part.to_owned()),
            ("{baseline}", context.baseline()),
        ];
        Self {
            rows,
            heading,
            words,
        }
    }

    /// A text with the values of the words in braces.
    pub(crate) fn fill(&self, text: &str) -> String {
        let put = |text: String, (word, value): &(&str, String)| text.replace(word, value);
        self.words.iter().fold(text.to_owned(), put)
    }

    /// The chapter and the heading above the text of an exhibit.
    pub(crate) fn above(&self, exhibit: &Exhibit) -> String {
        match (&exhibit.chapter, &self.heading) {
            (Some(chapter), Some(heading)) => format!("{chapter} ({heading})\n\n"),
            (Some(one), None) | (None, Some(one)) => format!("{one}\n\n"),
            (None, None) => String::new(),
        }
    }
}

/// The groups of rows that have tables and charts of their own.
pub(crate) fn places<'a>(context: &Context, rows: &[&'a Row], per: Per) -> Vec<Place<'a>> {
    let all = ("All views", "");
    let place = |rows, heading| Place::new(context, rows, heading, all);
    let own = rows.iter().copied();
    match per {
        Per::Run => vec![place(rows.to_vec(), None)],
        Per::Picture => {
            let pictures = grouped(own, |r| r.picture()).into_iter();
            pictures.map(|(_, rows)| place(rows, None)).collect()
        }
        Per::Stage => {
            let mut stages = grouped(own, |r| r.settings.stage == DrawStage::Compute);
            stages.sort_by_key(|(compute, _)| *compute);
            let stages = stages.into_iter();
            stages.map(|(_, rows)| place(rows, None)).collect()
        }
        Per::Size => {
            let sizes = grouped(own, |r| r.size());
            let several = sizes.len() > 1;
            let place = |(size, rows)| place(rows, several.then_some(size));
            sizes.into_iter().map(place).collect()
        }
        Per::Part => {
            let mut framings = grouped(own, |r| r.framing);
            framings.sort_by_key(|f| f.0 == Framing::Close);
            let mut parts = Vec::new();
            // A summary over both framings alone would hide what differs between them.
            if framings.len() > 1 {
                let heading = title("all together", rows);
                parts.push(place(rows.to_vec(), Some(heading)));
            }
            let ending = |f: Framing| match framings.len() {
                1 => String::new(),
                _ => format!("-{}", f.name()),
            };
            parts.extend(framings.iter().map(|(framing, rows)| {
                let views = match framing {
                    Framing::Whole => "Views of whole solids",
                    Framing::Close => "Close views",
                };
                // A run of one picture says in one place what that is.
                let several = grouped(context.rows, |r| r.picture()).len() > 1;
                let heading = several.then(|| title(framing.name(), rows));
                Place::new(context, rows.clone(), heading, (views, &ending(*framing)))
            }));
            parts
        }
    }
}

/// `close: 24 pictures, of which 44.8 to 80.5 % of the pixels are hit`.
fn title(name: &str, rows: &[&Row]) -> String {
    let pictures = grouped(rows, |r| r.picture());
    let shares = || pictures.iter().map(|(_, rows)| rows[0].covered());
    let least = shares().fold(f64::INFINITY, f64::min);
    let most = shares().fold(0.0, f64::max);
    let least = match pictures.len() {
        1 => String::new(),
        _ => format!("{} to ", number(100.0 * least, 3)),
    };
    let (count, most) = (count(pictures.len(), "picture"), percent(most));
    format!("{name}: {count}, of which {least}{most} of the pixels are hit")
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::measure::row::tests::timed;
    use crate::report::columns::tests::with_context;

    fn seen(view: usize, framing: Framing, hits: usize) -> Row {
        let mut row = timed(&[10.0]);
        (row.errors.pixels, row.errors.hits) = (200, hits);
        Row {
            view,
            framing,
            scene: format!("s{view}"),
            ..row
        }
    }

    #[test]
    fn each_framing_is_summed_up_by_itself_and_with_the_others() {
        let rows = [
            seen(0, Framing::Whole, 20),
            seen(0, Framing::Whole, 20),
            seen(1, Framing::Close, 100),
            seen(2, Framing::Close, 150),
        ];
        with_context(&rows, |context| {
            let found = places(context, context.rows, Per::Part);
            let title = |p: &Place| p.heading.clone().unwrap_or_default();
            let parts = found.iter().map(|p| (title(p), p.rows.len()));
            let wanted = [
                (
                    "all together: 3 pictures, of which 10 to 75 % of the pixels are hit",
                    4,
                ),
                ("whole: 1 picture, of which 10 % of the pixels are hit", 2),
                (
                    "close: 2 pictures, of which 50 to 75 % of the pixels are hit",
                    2,
                ),
            ];
            assert_eq!(
                parts.collect::<Vec<_>>(),
                wanted.map(|(title, count)| (title.to_owned(), count))
            );
            // One framing needs no part of its own.
            assert_eq!(places(context, &context.rows[..2], Per::Part).len(), 1);
            assert!(places(context, &[], Per::Part).is_empty());
        });
        with_context(&rows[..2], |context| {
            let found = places(context, context.rows, Per::Part);
            assert_eq!((found.len(), found[0].heading.as_ref()), (1, None));
        });
    }
}
