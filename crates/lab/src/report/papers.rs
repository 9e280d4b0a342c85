//! The tables of frame rates that were published (article of 2022, tables 1 to 3), measured again,
//! each method beside the published figures.

mod chart;
mod printed;

pub use printed::{Printed, SIZES, TABLES, Trend};

use super::chapters;
use super::folder::{keep_figure, write_text};
use super::machine::Machine;
use super::measure::Measured;
use super::names::number;
use super::page::Page;
use super::pictures::Album;
use super::plan::{Plan, variant};
use super::ratios::between;
use super::row::Row;
use super::series_style::SeriesStyles;
use super::stats::Interval;
use super::suite;
use super::table::Table;
use super::text;
use super::view::View;
use crate::method::MethodSettings;
use chart::{Scaled, chart};
use revmap::error::Result;
use revmap::maps::{BakeOptions, MapSource, ShapeMap};
use revmap::scene::{Clip, Offset};
use std::path::Path;

/// The slope of the bevel in table 3.
const CHAMFERED_BEVEL: f64 = 0.8;

/// The nine views of the tables: table by table, value by value.
///
/// # Errors
/// Of the solid that the program carries.
pub fn views() -> Result<Vec<View>> {
    offset_views(&suite::one()?)
}

/// Each view plain and by every value of the tables, whole and cut by its box (names end in `-box`).
///
/// # Errors
/// Of baking maps.
pub fn all_techniques(views: &[View]) -> Result<Vec<View>> {
    let mut all = Vec::new();
    for base in views {
        all.push(base.clone());
        for whole in offset_views(base)? {
            let mut cut = whole.clone();
            cut.name += suite::CUT;
            for object in &mut cut.scene.objects {
                object.clip = Clip::Box;
            }
            all.extend([whole, cut]);
        }
    }
    Ok(all)
}

/// A view by every value of the tables.
fn offset_views(base: &View) -> Result<Vec<View>> {
    let largest = largest_distance(base)?;
    let mut views = Vec::new();
    for table in &TABLES {
        for value in table.values {
            let mut view = base.clone();
            view.name = format!("{}-{}{}", base.name, table.letter, number(value, 3));
            let offset = match table.letter {
                'e' => Offset {
                    extend: value * largest,
                    ..Offset::default()
                },
                'b' => Offset {
                    bevel: value * largest,
                    ..Offset::default()
                },
                _ => Offset {
                    bevel: CHAMFERED_BEVEL * largest,
                    chamfer: value,
                    ..Offset::default()
                },
            };
            view.scene
                .objects
                .iter_mut()
                .for_each(|o| o.offset = offset);
            views.push(view);
        }
    }
    Ok(views)
}

/// The largest distance that the papers' map of a view's solid holds, object units.
fn largest_distance(view: &View) -> Result<f64> {
    let mut largest = 0.0f64;
    for object in &view.scene.objects {
        let map = ShapeMap::bake(
            &object.profile,
            &BakeOptions::new(MapSource::Binary, object.map_rows),
        )?;
        largest = largest.max(f64::from(map.largest_distance()));
    }
    Ok(largest)
}

/// Speed from a table's first value to its last, with the ratio of the rates.
#[must_use]
pub fn trend(first: &Row, last: &Row) -> Option<(Trend, Interval)> {
    // Rates are one over times.
    let ratio = between(first, last)?;
    let trend = if ratio.low > 1.0 {
        Trend::Rises
    } else if ratio.high < 1.0 {
        Trend::Falls
    } else {
        Trend::Unclear
    };
    Some((trend, ratio))
}

/// One line of a table: a way of drawing at a size, its rate at each value.
struct Measures<'a> {
    way: MethodSettings,
    size: (u32, u32),
    rows: [Option<&'a Row>; 3],
}

fn lines<'a>(rows: &'a [Row], table: usize) -> Vec<Measures<'a>> {
    let mut lines: Vec<Measures> = Vec::new();
    for row in rows.iter().filter(|r| r.view / 3 == table) {
        let (way, size) = (
            variant(&row.settings),
            (row.settings.width, row.settings.height),
        );
        let place = row.view % 3;
        match lines.iter_mut().find(|l| l.way == way && l.size == size) {
            Some(line) => line.rows[place] = Some(row),
            None => {
                let mut line = Measures {
                    way,
                    size,
                    rows: [None; 3],
                };
                line.rows[place] = Some(row);
                lines.push(line);
            }
        }
    }
    lines.sort_by_key(|l| l.size);
    lines
}

/// One of the published tables, the published figures first.
fn measured_table(rows: &[Row], index: usize, styles: &SeriesStyles) -> Table {
    let table = &TABLES[index];
    let mut header = vec!["size".to_owned(), "method".to_owned(), "stage".to_owned()];
    header.extend(
        table
            .values
            .iter()
            .map(|v| format!("{} = {}", table.letter, number(*v, 3))),
    );
    header.extend(["last rate / first".to_owned(), "trend".to_owned()]);
    let all = lines(rows, index);
    let mut records = Vec::new();
    // At sizes of the reader's own nothing was published, and the rest stands alone.
    for lines in all.chunk_by(|a, b| a.size == b.size) {
        let size = lines[0].size;
        let printed = SIZES.iter().position(|printed| *printed == size);
        if let Some(rates) = printed.map(|k| table.rates[k]) {
            let mut published = vec![
                format!("{}x{}", size.0, size.1),
                "published, GT 630M".into(),
                "fragment".into(),
            ];
            published.extend(rates.iter().map(|r| number(*r, 4)));
            published.extend([
                number(rates[2] / rates[0], 3),
                table.claim.name().to_owned(),
            ]);
            records.push(published);
        }
        for line in lines {
            let mut record = vec![
                format!("{}x{}", size.0, size.1),
                styles.way(&line.way),
                line.way.stage.name().to_owned(),
            ];
            record.extend(
                line.rows
                    .iter()
                    .map(|row| match row.and_then(|r| r.time()) {
                        Some(time) => number(1e3 / time.value, 3),
                        None => "–".to_owned(),
                    }),
            );
            let found = line.rows[0]
                .zip(line.rows[2])
                .and_then(|(first, last)| trend(first, last));
            match found {
                Some((trend, ratio)) => {
                    record.extend([text::interval(&ratio, 3), trend.name().to_owned()])
                }
                None => record.extend(["–".to_owned(), "–".to_owned()]),
            }
            records.push(record);
        }
    }
    Table::new(header, records)
}

/// All three tables as text.
#[must_use]
pub fn as_text(rows: &[Row]) -> String {
    let styles = SeriesStyles::of(rows);
    let mut out = String::new();
    for (index, table) in TABLES.iter().enumerate() {
        out += &format!(
            "Table {}: {}, frames per second\n",
            table.number, table.title
        );
        out += &measured_table(rows, index, &styles).aligned();
        out.push('\n');
    }
    out
}

/// What may be compared, and what may not.
const COMPARABLE: [&str; 3] = [
    "The article names neither the solid, nor its textures, nor its share of the picture, and rounds rates to five frames a second. Its rates cannot be compared with ours on any \
     device. Its pictures hold a displacement map as well; ours here hold the plain solid, which is cheaper to shade.",
    "What can be compared is the trend along a line: how a rate changes as a parameter grows, all else equal. That is why each line ends with the ratio of its last rate to its first, with the interval of \
     this run.",
    "e and b are fractions of the largest distance that the map of the plain solid holds, as the papers scale them; the bevel's 25 steps are followed by 10 halvings there, 35 \
     look-ups in all. Offsets grow the solid until its box cuts it, so that the share of the picture that is hit changes with them, which moves rates by itself.",
];

/// Writes the page of the tables.
///
/// # Errors
/// When a file cannot be written.
pub fn write(
    folder: &Path,
    plan: &Plan,
    measured: &Measured,
    machine: &Machine,
    album: &Album,
) -> Result<()> {
    let rows = &measured.rows;
    let styles = SeriesStyles::of(rows);
    let mut page = Page::new("revmap: the published tables, measured again");
    chapters::begin(&mut page, machine, measured);
    page.chapter("What can be compared");
    COMPARABLE.iter().for_each(|words| page.text(words));
    for (index, table) in TABLES.iter().enumerate() {
        page.chapter(&format!("Table {}: {}", table.number, table.title));
        page.text("Frames per second: the published figures, and below them every method as measured here.");
        page.table(&measured_table(rows, index, &styles), &[0, 1, 2, 7]);
        for size in SIZES {
            let name = format!("table{}-{}x{}", table.number, size.0, size.1);
            for scale in [Scaled::Rate, Scaled::Trend] {
                let Some(figure) = chart(table, index, rows, size, &styles, scale) else {
                    continue;
                };
                keep_figure(folder, &format!("{name}-{}", scale.name()), &figure)?;
                page.figure(&figure, &scale.caption(table.letter));
            }
        }
    }
    page.chapter("All rows");
    chapters::row_table(&mut page, rows, &styles);
    chapters::pictures(&mut page, plan, album);
    chapters::end(&mut page, plan, measured);
    write_text(&folder.join("report.html"), &page.html())
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::super::row::tests::row;
    use super::super::view::Technique;
    use super::*;

    #[test]
    fn the_views_are_those_of_the_tables() {
        let views = views().unwrap();
        assert_eq!(views.len(), 9);
        for (k, wanted) in [
            Technique::Extended,
            Technique::Beveled,
            Technique::Chamfered,
        ]
        .into_iter()
        .enumerate()
        {
            assert!(
                views[3 * k..3 * k + 3]
                    .iter()
                    .all(|v| v.technique() == wanted)
            );
        }
        let offset = |k: usize| views[k].offset().unwrap();
        assert!((offset(2).extend / offset(0).extend - 3.2).abs() < 1e-9);
        assert!((offset(6).bevel - offset(5).bevel).abs() < 1e-12 && offset(8).chamfer == 0.7);
        views.iter().for_each(|v| v.scene.check().unwrap());
    }

    #[test]
    fn trends_are_told_only_when_they_are_sure() {
        let timed = |times: [f64; 4]| {
            row(&times
                .map(|t| [(None, t)])
                .iter()
                .map(|p| p.as_slice())
                .collect::<Vec<_>>())
        };
        let slow = timed([20.0, 20.4, 19.8, 20.1]);
        let fast = timed([10.0, 10.1, 9.9, 10.2]);
        let noisy = timed([14.0, 30.0, 20.0, 24.0]);
        assert_eq!(trend(&slow, &fast).unwrap().0, Trend::Rises);
        assert_eq!(trend(&fast, &slow).unwrap().0, Trend::Falls);
        assert_eq!(trend(&slow, &noisy).unwrap().0, Trend::Unclear);
    }

    #[test]
    fn a_line_holds_its_three_values() {
        let mut rows = Vec::new();
        for (view, ms) in [(3, 10.0), (4, 8.0), (5, 5.0), (0, 1.0)] {
            let mut r = row(&[&[(None, ms)], &[(None, ms)]]);
            r.view = view;
            rows.push(r);
        }
        for (view, ms) in [(3, 4.0), (4, 4.0), (5, 4.0)] {
            let mut r = row(&[&[(None, ms)], &[(None, ms)]]);
            r.view = view;
            (r.settings.width, r.settings.height) = (1000, 600);
            rows.push(r);
        }
        let styles = SeriesStyles::of(&rows);
        let records = measured_table(&rows, 1, &styles).records;
        // Published figures stand above what was measured at their size, and nowhere else.
        assert_eq!(records.len(), 3);
        assert_eq!(records[2][..3], ["1000x600", "circle", "fragment"]);
        assert_eq!(records[2][3..6], ["250", "250", "250"]);
        assert_eq!(records[0][3..], ["200", "210", "230", "1.15", "rises"]);
        assert_eq!(records[1][3..7], ["100", "125", "200", "2 (2 to 2)"]);
    }
}
