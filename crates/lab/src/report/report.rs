//! The report of a run: its tables and charts as a page, as files beside it, and as text.

use super::columns::{COLUMNS, Context};
use super::exhibit::{self, Exhibit, Extra};
use super::flight::{self, FlightTimes};
use super::folder::{excluded, keep_figure, write_text};
use super::glossary;
use super::machine::Machine;
use super::measure::Measured;
use super::names::number;
use super::page::Page;
use super::pictures::{Album, heat_key};
use super::places::{Place, places};
use super::plan::{Plan, PlanFile, variant};
use super::ratios::Over;
use super::row::{CLOCKS_APART, Row};
use super::series_style::SeriesStyles;
use super::table::Table;
use revmap::error::Result;
use std::path::Path;

/// All that came out of a run.
pub struct Run<'a> {
    /// The plan's file.
    pub file: &'a PlanFile,
    /// The plan.
    pub plan: &'a Plan,
    /// The rows.
    pub measured: &'a Measured,
    /// The machine.
    pub machine: &'a Machine,
    /// Pictures.
    pub album: &'a Album,
    /// Flights.
    pub flights: &'a [FlightTimes],
    /// Figures in charts that are not rows.
    pub extra: Extra,
}

impl Run<'_> {
    /// Writes the page, the charts and the tables that are files; returns the text of the tables
    /// that are printed.
    pub fn write(&self, folder: &Path) -> Result<String> {
        let rows: Vec<&Row> = self.measured.rows.iter().collect();
        let resolved = self.file.time.resolved;
        let context = Context::new(&rows, self.plan, self.machine, resolved);
        let mut page = Page::new(self.file.title.as_str());
        exhibit::findings(&context)
            .into_iter()
            .for_each(|found| page.lead(found));
        if let Some(note) = exhibit::unresolved(&context) {
            page.note(&note);
        }
        if self.measured.interrupted {
            page.note("The run was interrupted: what is missing below was not measured.");
        }
        let exhibits = exhibit::all(&self.file.exhibit)?;
        let mut text = String::new();
        let mut began = None;
        for name in &self.file.show {
            let Some(exhibit) = exhibits.iter().find(|e| e.name == *name) else {
                continue;
            };
            if let Some(chapter) = &exhibit.chapter {
                began = Some((chapter.clone(), &exhibit.text));
            }
            text += &self.show(&context, exhibit, &mut page, &mut began, folder)?;
        }
        self.end(&mut page);
        write_text(&folder.join("report.html"), &page.html())?;
        Ok(text)
    }

    /// Writes one exhibit; its chapter begins with the first thing that there is to show.
    fn show(
        &self,
        context: &Context,
        exhibit: &Exhibit,
        page: &mut Page,
        began: &mut Option<(String, &Vec<String>)>,
        folder: &Path,
    ) -> Result<String> {
        let mut begin = |page: &mut Page| {
            if let Some((chapter, paragraphs)) = began.take() {
                page.chapter(&chapter);
                paragraphs.iter().for_each(|p| page.text(p));
            }
        };
        if exhibit.name == "shots" {
            if !self.album.shots.is_empty() {
                begin(page);
                shots(page, self.plan, self.album);
            }
            return Ok(String::new());
        }
        let rows = exhibit.rows(context);
        if rows.is_empty() {
            return Ok(String::new());
        }
        // Names say what differs among these rows, and no more.
        let ways: Vec<_> = rows.iter().map(|r| variant(&r.settings)).collect();
        let context = &Context {
            styles: SeriesStyles::new(&ways),
            ..*context
        };
        if exhibit.chart.is_empty() && exhibit.table.is_empty() {
            begin(page);
        }
        let mut text = String::new();
        for place in places(context, &rows, exhibit.per) {
            let mut heading = place.heading.clone();
            let mut head = |page: &mut Page| {
                begin(page);
                if let Some(heading) = heading.take() {
                    page.heading(&capital(&heading));
                }
            };
            for (k, answer) in exhibit.answers(context, &place.rows).iter().enumerate() {
                if k == 0 {
                    text += &place.above(exhibit);
                }
                head(page);
                page.text(answer);
                text += &format!("{answer}\n\n");
            }
            for chart in &exhibit.chart {
                self.chart(context, chart, &place, page, &mut head, folder)?;
            }
            for table in &exhibit.table {
                text += &self.table(context, exhibit, table, &place, page, &mut head, folder)?;
            }
        }
        Ok(text)
    }

    fn chart(
        &self,
        context: &Context,
        chart: &exhibit::Chart,
        place: &Place,
        page: &mut Page,
        head: &mut dyn FnMut(&mut Page),
        folder: &Path,
    ) -> Result<()> {
        let mut own = chart.clone();
        own.title = place.fill(&chart.title);
        own.guide = place.fill(&chart.guide);
        let figures = own.figures(context, &place.rows, &self.extra)?;
        for (k, figure) in figures.iter().enumerate() {
            let mut name = place.fill(&chart.file);
            if k > 0 {
                name += &format!("-{}", k + 1);
            }
            keep_figure(folder, &name, figure)?;
            head(page);
            let mut caption = place.fill(&chart.caption);
            if chart.is_timed() {
                caption += &place.untimed();
            }
            page.figure(figure, &caption);
        }
        Ok(())
    }

    /// Writes a table; returns its text if it is printed.
    #[allow(clippy::too_many_arguments)]
    fn table(
        &self,
        context: &Context,
        exhibit: &Exhibit,
        table: &exhibit::Table,
        place: &Place,
        page: &mut Page,
        head: &mut dyn FnMut(&mut Page),
        folder: &Path,
    ) -> Result<String> {
        let shown = match table.of {
            exhibit::Records::Flights => flight::table(self.flights),
            _ => table.shown(context, &place.rows)?,
        };
        if shown.records.is_empty() {
            let missing = table.print && table.over == Some(Over::Baseline);
            let heading = place.heading.as_ref().filter(|_| missing);
            let text = |h| format!("{h}\n\nno ratios: no usable row of the RBM baseline\n\n");
            return Ok(heading.map(text).unwrap_or_default());
        }
        head(page);
        if !table.heading.is_empty() {
            page.heading(&table.heading);
        }
        page.table(&shown, &exhibit::left(&shown));
        if let Some(file) = &table.csv {
            let table = context.file(&place.rows, &table.columns)?;
            write_text(&folder.join(file), &table.csv())?;
        }
        if !table.print {
            return Ok(String::new());
        }
        let above = match (table.heading.is_empty(), exhibit.question) {
            (false, _) => format!("{}\n\n", table.heading),
            (true, None) => place.above(exhibit),
            // The answer has it above.
            (true, Some(_)) => String::new(),
        };
        Ok(format!("{above}{}\n", shown.aligned()))
    }

    /// The end of every page: methods, excluded rows, the machine and how it was measured, columns.
    fn end(&self, page: &mut Page) {
        let measured = self.measured;
        glossary::chapter(page, measured);
        let out = excluded(self.plan, measured);
        page.chapter("Excluded rows");
        if out.records.is_empty() {
            page.text("None: every measurement could be made, and in every row the device's clock and the wall clock agree.");
        } else {
            page.text("These rows are in no summary, ratio or Pareto front. Row numbers count the records of results.csv; rows without a number could not be drawn.");
            page.table(&out, &[1, 2, 3, 4]);
        }
        page.chapter("How this was measured");
        page.facts(&self.machine.lines());
        let samples = measured.rows.iter().map(|r| r.frame_ms().len());
        let passes = || measured.rows.iter().map(|r| r.passes.len());
        let (least, most) = (passes().min().unwrap_or(0), passes().max().unwrap_or(0));
        let passes = match least == most {
            true => least.to_string(),
            false => format!("{least} to {most}"),
        };
        let wide = 100.0 * self.file.time.resolved;
        let limit = self.file.time.limit().as_secs_f64();
        let added = match self.file.time.is_fixed() {
            true => String::new(),
            false => format!(
                " Passes were added to pictures with such a time until it was resolved or {} s had passed. Stopping so makes intervals a little too narrow.",
                number(limit, 3)
            ),
        };
        page.text(&format!(
            "All ways of drawing one picture are drawn in turn, one frame each and there and back, so that a machine that slows down slows all of them; drivers' compilers \
             run before the first frame that counts. This is repeated in {passes} passes over all pictures, each with maps, buffers and pipelines made anew; {} to {} \
             frames of each row were timed in {} s. A time is the geometric mean of the passes' medians, its interval Student's over the passes, with 95 % confidence: it covers how this \
             run would have come out again on this machine, not how another machine would. A time whose interval reaches more than {wide:.0} % to either side is not resolved.{added}",
            samples.clone().min().unwrap_or(0),
            samples.max().unwrap_or(0),
            number(measured.took.as_secs_f64(), 3),
        ));
        page.text(&format!(
            "The device's timestamps stand around the work of one frame in one stage alone; the wall clock counts from submission to completion, without reading back. Rows in \
             which the two are more than {:.0} % apart are marked and excluded from every summary. Ratios pair frames of the same round. Frames that are timed hold colour \
             alone; errors and look-ups come from one more frame of the same search with all planes.",
            100.0 * CLOCKS_APART
        ));
        page.text("Errors are against the double-precision reference on the CPU, which shares no code with the shaders, unless the page says otherwise.");
        page.chapter("Columns");
        page.text("Headings of tables, names in files, and what they mean.");
        let name = |c: &super::columns::Column| match c.name == c.heading {
            true => c.name.to_owned(),
            false => format!("{}, {}", c.heading, c.name),
        };
        let facts: Vec<_> = COLUMNS
            .iter()
            .map(|c| (name(c), c.meaning.to_owned()))
            .collect();
        page.facts(&facts);
    }
}

/// The pictures of each view: one by itself, then pairs of heat maps in even columns.
fn shots(page: &mut Page, plan: &Plan, album: &Album) {
    page.text(&heat_key());
    for (index, view) in plan.views.iter().enumerate() {
        let shots: Vec<_> = album.shots.iter().filter(|s| s.view == index).collect();
        if shots.is_empty() {
            continue;
        }
        page.heading(&view.name);
        let (first, rest) = shots.split_at(1);
        page.shots(first);
        if !rest.is_empty() {
            page.shots(rest);
        }
    }
}

/// A heading of words that begin small.
fn capital(words: &str) -> String {
    let mut letters = words.chars();
    let first = letters.next().into_iter().flat_map(char::to_uppercase);
    first.chain(letters).collect()
}

/// `results.csv`: one record a row.
pub fn results(rows: &[Row], plan: &Plan, machine: &Machine, resolved: f64) -> Result<Table> {
    let rows: Vec<&Row> = rows.iter().collect();
    let context = Context::new(&rows, plan, machine, resolved);
    context.file(&rows, &super::columns::results().collect::<Vec<_>>())
}
