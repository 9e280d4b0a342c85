//! The report of a run: its tables and charts as a page, as files beside it, and as text.

pub mod columns;
pub mod exhibit;
pub mod flight;
pub mod folder;
pub mod glossary;
pub mod pictures;
pub mod plan_file;
mod published;
pub mod series_style;

pub use revmap_figures::table;

use crate::measure::Measured;
use crate::measure::machine::Machine;
use crate::measure::ratios::Over;
use crate::measure::row::{CLOCKS_APART, Row, SUBMISSION_MS};
use crate::plan::Plan;
use crate::report::columns::{COLUMNS, Column, Context};
use crate::report::exhibit::Exhibit;
use crate::report::exhibit::places::{Place, places};
use crate::report::plan_file::PlanFile;
use crate::report::series_style::SeriesStyles;
use flight::FlightTimes;
use folder::{excluded, keep_figure, write_text};
use pictures::{Album, heat_key};
use revmap::error::Result;
use revmap_figures::names::number;
use revmap_figures::page::Page;
use std::path::Path;

/// All that came out of a run.
#[allow(missing_docs)] // names say it
pub struct Run<'a> {
    pub file: &'a PlanFile,
    pub plan: &'a Plan,
    pub measured: &'a Measured,
    pub machine: &'a Machine,
    pub album: &'a Album,
    pub flights: &'a [FlightTimes],
}

impl Run<'_> {
    /// Writes page, charts and tables; returns the text of the tables that are printed, for a
    /// terminal of this width if it is for one.
    pub fn write(&self, folder: &Path, width: Option<usize>) -> Result<String> {
        let rows: Vec<&Row> = self.measured.rows.iter().collect();
        let resolved = self.file.time.resolved;
        let context = Context::new(&rows, self.plan, self.machine, resolved);
        let mut page = Page::new(self.file.title.as_str());
        let findings = exhibit::findings(&context).into_iter();
        findings.for_each(|found| page.lead(found));
        if let Some(note) = exhibit::unresolved(&context) {
            page.note(&note);
        }
        if self.measured.interrupted {
            page.note("The run was interrupted: what is missing below was not measured.");
        }
        let exhibits = exhibit::all(&self.file.exhibit)?;
        let named = |name: &String| exhibits.iter().find(|e| e.name == *name);
        let mut writer = Writer {
            run: self,
            folder,
            width,
            page,
            text: String::new(),
            chapter: None,
            heading: None,
        };
        for exhibit in self.file.show.iter().filter_map(named) {
            writer.show(&context, exhibit)?;
        }
        let Writer { mut page, text, .. } = writer;
        self.end(&mut page);
        write_text(&folder.join("report.html"), &page.html())?;
        Ok(text)
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
            page.table(&out);
        }
        page.chapter("How this was measured");
        page.facts(&self.machine.lines);
        let ends = |of: fn(&Row) -> usize| {
            let all = || measured.rows.iter().map(of);
            (all().min().unwrap_or(0), all().max().unwrap_or(0))
        };
        let (fewest, most) = ends(|row| row.frame_ms().len());
        let passes = match ends(|row| row.passes.len()) {
            (least, most) if least == most => least.to_string(),
            (least, most) => format!("{least} to {most}"),
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
             run before the first frame that counts. This is repeated in {passes} passes over all pictures, each with maps, buffers and pipelines made anew; {fewest} to {most} \
             frames of each row were timed in {} s. A time is the geometric mean of the passes' medians, its interval Student's over the passes, with 95 % confidence: it covers how this \
             run would have come out again on this machine, not how another machine would. A time whose interval reaches more than {wide:.0} % to either side is not resolved.{added}",
            number(measured.took.as_secs_f64(), 3),
        ));
        page.text(&format!(
            "The device's timestamps stand around the work of one frame in one stage alone; the wall clock counts from submission to completion, without reading back. Rows in \
             which the two are more than {:.0} % apart, without {SUBMISSION_MS} ms of submission, are marked and excluded from every summary. Ratios pair frames of the same round. Frames that are timed hold colour \
             alone; errors and look-ups come from one more frame of the same search with all planes.",
            100.0 * CLOCKS_APART
        ));
        page.text("Errors are against the double-precision reference on the CPU, which shares no code with the shaders, unless the page says otherwise.");
        page.chapter("Columns");
        page.text("Headings of tables, names in files, and what they mean.");
        let fact = |c: &Column| match c.name == c.heading {
            true => (c.name.to_owned(), c.meaning.to_owned()),
            false => (format!("{}, {}", c.heading, c.name), c.meaning.to_owned()),
        };
        page.facts(&COLUMNS.iter().map(fact).collect::<Vec<_>>());
    }
}

/// A page in the making, and the text that is printed.
struct Writer<'a> {
    run: &'a Run<'a>,
    folder: &'a Path,
    width: Option<usize>,
    page: Page,
    text: String,
    /// A chapter and its paragraphs, and a heading: they begin with the first thing to show.
    chapter: Option<(&'a str, &'a [String])>,
    heading: Option<String>,
}

impl<'a> Writer<'a> {
    /// Writes what begins here.
    fn begin(&mut self) {
        if let Some((chapter, paragraphs)) = self.chapter.take() {
            self.page.chapter(chapter);
            paragraphs.iter().for_each(|p| self.page.text(p));
        }
        if let Some(heading) = self.heading.take() {
            self.page.heading(&capital(&heading));
        }
    }

    fn show(&mut self, context: &Context, exhibit: &'a Exhibit) -> Result<()> {
        self.heading = None;
        if let Some(chapter) = &exhibit.chapter {
            self.chapter = Some((chapter, &exhibit.text));
        }
        if exhibit.name == "shots" {
            if !self.run.album.shots.is_empty() {
                self.begin();
                shots(&mut self.page, self.run.plan, self.run.album)?;
            }
            return Ok(());
        }
        let rows = exhibit.rows(context);
        if rows.is_empty() {
            return Ok(());
        }
        // Names say what differs among these rows, and no more.
        let context = &Context {
            styles: SeriesStyles::of(&rows),
            ..*context
        };
        if exhibit.chart.is_empty() && exhibit.table.is_empty() {
            self.begin();
        }
        for place in places(context, &rows, exhibit.per) {
            self.heading.clone_from(&place.heading);
            let answers = exhibit.answers(context, &place.rows);
            if !answers.is_empty() {
                self.begin();
                self.text += &place.above(exhibit);
            }
            for answer in answers {
                self.page.text(&answer);
                self.text += &format!("{answer}\n\n");
            }
            for chart in &exhibit.chart {
                self.chart(context, chart, &place)?;
            }
            for table in &exhibit.table {
                self.table(context, exhibit, table, &place)?;
            }
        }
        Ok(())
    }

    fn chart(&mut self, context: &Context, chart: &exhibit::Chart, place: &Place) -> Result<()> {
        let mut own = chart.clone();
        own.title = place.fill(&chart.title);
        own.guide = place.fill(&chart.guide);
        let caption = place.fill(&chart.caption);
        let figures = own.figures(context, &place.rows)?;
        for (k, figure) in figures.iter().enumerate() {
            let mut name = place.fill(&chart.file);
            if k > 0 {
                name += &format!("-{}", k + 1);
            }
            keep_figure(self.folder, &name, figure)?;
            self.begin();
            self.page.figure(figure, &caption);
        }
        Ok(())
    }

    fn table(
        &mut self,
        context: &Context,
        exhibit: &Exhibit,
        table: &exhibit::Table,
        place: &Place,
    ) -> Result<()> {
        let shown = match table.of {
            exhibit::Records::Flights => flight::table(self.run.flights, context.rows),
            _ => table.shown(context, &place.rows)?,
        };
        let shown = match context.over_pictures(1).is_empty() {
            true => shown.without("pictures"),
            false => shown,
        };
        if shown.records.is_empty() {
            if table.print && table.over == Some(Over::Baseline) {
                let none = "no ratios: no usable row of the RBM baseline";
                let heading = place.heading.iter().map(|heading| format!("{heading}\n\n"));
                self.text += &heading.chain([format!("{none}\n\n")]).collect::<String>();
            }
            return Ok(());
        }
        self.begin();
        if !table.heading.is_empty() {
            self.page.heading(&table.heading);
        }
        self.page.table(&shown);
        if let Some(file) = &table.csv {
            let table = context.file(&place.rows, &table.columns)?;
            write_text(&self.folder.join(file), &table.csv())?;
        }
        if table.print {
            self.text += &match (table.heading.is_empty(), exhibit.question) {
                (false, _) => format!("{}\n\n", table.heading),
                (true, None) => place.above(exhibit),
                // The answer has it above.
                (true, Some(_)) => String::new(),
            };
            self.text += &format!("{}\n", shown.within(self.width, "report.html"));
        }
        Ok(())
    }
}

/// The pictures of each view: one by itself, then pairs of heat maps in even columns.
fn shots(page: &mut Page, plan: &Plan, album: &Album) -> Result<()> {
    page.text(&heat_key());
    for (index, view) in plan.views.iter().enumerate() {
        let own = album.shots.iter().filter(|s| s.0 == index);
        let shots: Vec<_> = own.map(|s| s.1.clone()).collect();
        let Some((first, rest)) = shots.split_first() else {
            continue;
        };
        page.heading(&view.name);
        page.shots(std::slice::from_ref(first))?;
        if !rest.is_empty() {
            page.shots(rest)?;
        }
    }
    Ok(())
}

/// A heading of words that begin small.
fn capital(words: &str) -> String {
    let mut letters = words.chars();
    let first = letters.next().into_iter().flat_map(char::to_uppercase);
    first.chain(letters).collect()
}
