//! Which pictures a run shows, and the share of each that is solid: where little is hit, what a
//! frame costs anyhow weighs much in its time.

use super::names::number;
use super::names::percent;
use super::plan::grouped;
use super::row::Row;
use super::view::Framing;

/// Rows of one framing, or of all.
#[derive(Clone, Debug, PartialEq)]
pub struct Part {
    /// Which framing; `None` where rows of several are summed up.
    pub framing: Option<Framing>,
    /// The rows.
    pub rows: Vec<Row>,
}

impl Part {
    /// Its content in words: `close: 24 pictures, of which 44.8 to 80.5 % of the pixels are
    /// hit`.
    #[must_use]
    pub fn title(&self) -> String {
        let rows: Vec<&Row> = self.rows.iter().collect();
        let pictures = pictures_of(&rows);
        let shares = || {
            pictures
                .iter()
                .filter_map(|p| p.first())
                .map(|r| r.covered())
        };
        let least = shares().fold(f64::INFINITY, f64::min);
        let most = shares().fold(0.0, f64::max);
        let name = self.framing.map_or("all together", Framing::name);
        let (count, hit) = match pictures.len() {
            0 => return format!("{name}: no pictures"),
            1 => ("1 picture".to_owned(), percent(most)),
            n => (
                format!("{n} pictures"),
                format!("{} to {}", number(100.0 * least, 3), percent(most)),
            ),
        };
        format!("{name}: {count}, of which {hit} of the pixels are hit")
    }

    /// The name of its views in charts.
    #[must_use]
    pub fn views(&self) -> &'static str {
        match self.framing {
            None => "All views",
            Some(Framing::Whole) => "Views of whole solids",
            Some(Framing::Close) => "Close views",
        }
    }

    /// The ending of its files' names: nothing for the part that holds all.
    #[must_use]
    pub fn ending(&self, parts: &[Self]) -> String {
        match self.framing {
            Some(framing) if parts.len() > 1 => format!("-{}", framing.name()),
            _ => String::new(),
        }
    }
}

/// All rows, then, where there are several framings, those of each: a summary over both alone would
/// hide what differs between them.
#[must_use]
pub fn parts(rows: &[Row]) -> Vec<Part> {
    let of = |framing: Framing| Part {
        framing: Some(framing),
        rows: rows
            .iter()
            .filter(|r| r.framing == framing)
            .cloned()
            .collect(),
    };
    let mut each: Vec<Part> = Framing::ALL.into_iter().map(of).collect();
    each.retain(|part| !part.rows.is_empty());
    if each.len() > 1 {
        let all = Part {
            framing: None,
            rows: rows.to_vec(),
        };
        each.insert(0, all);
    }
    each
}

/// Rows put together by the picture they show.
pub(super) fn pictures_of<'a>(rows: &[&'a Row]) -> Vec<Vec<&'a Row>> {
    let key = |r: &Row| (r.view, r.settings.width, r.settings.height);
    grouped(rows, |a, b| key(a) == key(b))
}

#[cfg(test)]
mod tests {
    use super::super::row::tests::row;
    use super::*;

    fn seen(view: usize, framing: Framing, hits: usize) -> Row {
        let mut row = row(&[&[(None, 10.0)]]);
        row.errors.pixels = 200;
        row.errors.hits = hits;
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
        let titles: Vec<String> = parts(&rows).iter().map(Part::title).collect();
        assert_eq!(
            titles,
            [
                "all together: 3 pictures, of which 10 to 75 % of the pixels are hit",
                "whole: 1 picture, of which 10 % of the pixels are hit",
                "close: 2 pictures, of which 50 to 75 % of the pixels are hit",
            ]
        );
        let counts: Vec<usize> = parts(&rows).iter().map(|p| p.rows.len()).collect();
        assert_eq!(counts, [4, 2, 2]);
        // One framing needs no part of its own.
        assert_eq!(parts(&rows[..2]).len(), 1);
        assert!(parts(&[]).is_empty());
    }
}
