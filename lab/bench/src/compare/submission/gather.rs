//! Submissions side by side: a table and a chart across devices.

use super::{Line, OnePicture, Submission};
use crate::measure::machine;
use crate::plan::RBM_BASELINE;
use crate::plan::method::Method;
use crate::report::columns::{Cell, RESOLVED};
use crate::report::folder::{keep_figure, write_text};
use revmap::error::{Error, ErrorKind, Result};
use revmap_figures::chart::Figure;
use revmap_figures::chart::dots::{self, Placed};
use revmap_figures::chart::style::Style;
use revmap_figures::groups::grouped;
use revmap_figures::names::{number, percent};
use revmap_figures::page::Page;
use revmap_figures::stats::Interval;
use revmap_figures::table::Table;
use std::path::{Path, PathBuf};

/// A submission and its name among the others.
pub struct Named {
    /// The device and the driver's version; a number follows if several have the same.
    pub label: String,
    /// The file's name, without its folder.
    pub file: String,
    /// The figures.
    pub submission: Submission,
}

/// Reads submissions in their order.
///
/// # Errors
/// Those of [`Submission::load`]; [`ErrorKind::Usage`] for a file whose content was given before.
pub fn load(files: &[PathBuf]) -> Result<Vec<Named>> {
    let mut all: Vec<Named> = Vec::new();
    for file in files {
        let submission = Submission::load(file)?;
        if let Some(twin) = all.iter().find(|known| known.submission == submission) {
            let message = format!(
                "holds the same submission as {}; give each one once",
                twin.file
            );
            return Err(Error::new(ErrorKind::Usage, message)
                .in_file(file)
                .at_key("--gather"));
        }
        let file = file.file_name().unwrap_or_default().to_string_lossy();
        all.push(Named {
            label: machine::label(&submission.device.name, &submission.device.driver),
            file: file.into_owned(),
            submission,
        });
    }
    let labels: Vec<String> = all.iter().map(|one| one.label.clone()).collect();
    for (place, one) in all.iter_mut().enumerate() {
        let same = |labels: &[String]| labels.iter().filter(|l| **l == one.label).count();
        let (count, before) = (same(&labels), same(&labels[..place]));
        if count > 1 {
            one.label += &format!(" ({})", before + 1);
        }
    }
    Ok(all)
}

/// A warning for each submission that drew another scene under a name than one before it, and one for
/// all that do not say what they drew.
pub fn warnings(all: &[Named]) -> Vec<String> {
    let different = |(number, one): (usize, &Named)| {
        let differing = |other: &Named| -> Vec<String> {
            let views = one.submission.drawn.iter();
            let known = |name: &String| other.submission.drawn.get(name);
            let views = views.filter(|(name, own)| known(name).is_some_and(|d| d != *own));
            views.map(|(name, _)| name.clone()).collect()
        };
        let mut others = all[..number].iter().map(|o| (o, differing(o)));
        let (other, views) = others.find(|(_, views)| !views.is_empty())?;
        let (a, b, views) = (&other.file, &one.file, views.join(", "));
        Some(format!(
            "{a} and {b} drew different scenes as {views}: their figures do not compare"
        ))
    };
    let silent = all.iter().filter(|one| one.submission.drawn.is_empty());
    let silent: Vec<&str> = silent.map(|one| one.file.as_str()).collect();
    let silent = (!silent.is_empty()).then(|| {
        let files = silent.join(", ");
        format!("no digests of scenes in {files}, of an earlier version: views of one name are taken for one scene")
    });
    let found = all.iter().enumerate().filter_map(different);
    found.chain(silent).collect()
}

/// Writes `results.csv`, `report.html` and the charts; returns the table that is printed, for a
/// terminal of this width if it is for one.
pub fn write(all: &[Named], folder: &Path, width: Option<usize>) -> Result<String> {
    write_text(&folder.join("results.csv"), &results(all).csv())?;
    let mut page = Page::new("revmap: figures of several devices");
    all.iter().for_each(|one| page.lead(finding(one)));
    page.chapter("Devices");
    page.table(&devices(all));
    warnings(all).iter().for_each(|text| page.text(text));
    page.chapter("Against the RBM baseline");
    page.text("Each method's time of a frame over that of one RBM baseline for both stages, drawn in the fragment stage by the same device: geometric means over the pictures, with 95 % intervals. Below 1 the method is faster. Ratios of devices compare; times depend on what else a machine does.");
    for (count, figure) in charts(all).into_iter().enumerate() {
        let name = match count {
            0 => "devices".to_owned(),
            more => format!("devices-{}", more + 1),
        };
        keep_figure(folder, &name, &figure)?;
        page.figure(&figure, "Time of each method over that of the RBM baseline on the same device, with its 95 % interval; the value is behind its name. Further left is faster. Markers are filled in the fragment stage and hollow in the compute stage.");
    }
    let ratios = across(all, &|line| shown(line.ratio));
    page.table(&ratios);
    page.heading("Milliseconds");
    page.table(&across(all, &|line| shown(line.time_ms)));
    page.chapter("Errors");
    page.text("Wrong pixels over the pixels hit, and the geometric mean of the depth errors (99th percentile, h/512), against the double-precision reference.");
    let errors = across(all, &|line| {
        let depth = line.depth_p99.map(|d| number(d, 3));
        let wrong = line.wrong.map(percent);
        match wrong.zip(depth) {
            Some((wrong, depth)) => format!("{wrong}; {depth}"),
            None => "–".to_owned(),
        }
    });
    page.table(&errors);
    page.chapter("Shaders");
    page.text("Statistics of the drivers' compilers. A driver without VK_KHR_pipeline_executable_properties gives none.");
    let shaders = shaders(all);
    if !shaders.records.is_empty() {
        page.table(&shaders);
    }
    write_text(&folder.join("report.html"), &page.html())?;
    Ok(ratios.within(width, "report.html"))
}

/// The sentence on one device.
fn finding(one: &Named) -> String {
    let default = |stage: &str| {
        let line = main_lines(one).find(|l| l.method == Method::DEFAULT.name() && l.stage == stage);
        line.map_or("an unknown part".to_owned(), |line| shown(line.ratio))
    };
    format!(
        "On {} `{}` takes {} of the RBM baseline's time in the fragment stage, and {} in the compute stage.",
        one.label,
        Method::DEFAULT.name(),
        default("fragment"),
        default("compute"),
    )
}

/// The lines over all pictures.
fn main_lines(one: &Named) -> impl Iterator<Item = &Line> {
    one.submission.lines.iter().filter(|l| l.part == "all")
}

/// `0.5 (0.4 to 0.6)`.
fn shown([value, low, high]: super::Figure) -> String {
    Cell::Known(Interval::new(value, low, high)).shown()
}

/// A column of [`results`] or [`devices`].
type Facts = &'static [(&'static str, fn(&Named) -> &str)];

/// What tables say of each submission.
const FACTS: Facts = &[
    ("submission", |o| &o.label),
    ("device", |o| &o.submission.device.name),
    ("driver", |o| &o.submission.device.driver),
    ("vulkan", |o| &o.submission.device.vulkan),
    ("processor", |o| &o.submission.device.processor),
    ("system", |o| &o.submission.device.system),
    ("program", |o| &o.submission.program),
    ("plan", |o| &o.submission.plan),
    ("clock", |o| &o.submission.clock),
    ("size", |o| &o.submission.size),
    ("date", |o| &o.submission.date),
];

fn facts(one: &Named) -> Vec<String> {
    FACTS.iter().map(|(_, of)| of(one).to_owned()).collect()
}

/// `results.csv`: a record for each line of each submission.
fn results(all: &[Named]) -> Table {
    let own = "part,method,stage,pictures,time_ms,time_low_ms,time_high_ms,ratio,ratio_low,ratio_high,wrong,depth_p99,worst_depth_p99";
    let header = FACTS.iter().map(|(name, _)| *name).chain(own.split(','));
    let record = |one: &Named, line: &Line| {
        let mut record = facts(one);
        record.extend([&line.part, &line.method, &line.stage].map(Clone::clone));
        record.push(line.pictures.to_string());
        let figures = line.time_ms.into_iter().chain(line.ratio).map(Some);
        let errors = [line.wrong, line.depth_p99, line.worst_depth_p99];
        record.extend(figures.chain(errors).map(|v| Cell::number(v).csv()));
        record
    };
    let mut records = Vec::new();
    for one in all {
        let lines = one.submission.lines.iter();
        records.extend(lines.map(|line| record(one, line)));
    }
    Table::new(header, records)
}

/// The devices, and how many of their pictures equal those of the first device of the same size.
fn devices(all: &[Named]) -> Table {
    let equal = |one: &Named| {
        let own = &one.submission;
        let first = all.iter().find(|o| o.submission.size == own.size);
        let first = first.map_or(own, |first| &first.submission);
        let twin = |p: &&OnePicture| {
            let key = |p: &OnePicture| [&p.scene, &p.method, &p.stage, &p.colors].map(Clone::clone);
            first.pictures.iter().any(|other| key(other) == key(p))
        };
        let count = own.pictures.iter().filter(twin).count();
        format!("{count} of {}", own.pictures.len())
    };
    let header = FACTS.iter().map(|(name, _)| *name);
    let header = header.chain(["kind", "file", "colours as on the first"]);
    let record = |one: &Named| {
        let kind = one.submission.device.kind.clone();
        [facts(one), vec![kind, one.file.clone(), equal(one)]].concat()
    };
    Table::new(header, all.iter().map(record).collect())
}

/// A table with a row for each line that any submission has, and a column for each submission.
fn across(all: &[Named], cell: &dyn Fn(&Line) -> String) -> Table {
    let key = |line: &Line| [&line.part, &line.method, &line.stage].map(Clone::clone);
    let lines = || all.iter().flat_map(|one| &one.submission.lines);
    let keys = grouped(lines(), |line| key(line)).into_iter();
    let header = ["part", "method", "stage"].map(str::to_owned).into_iter();
    let header = header.chain(all.iter().map(|one| one.label.clone()));
    let record = |(wanted, _): ([String; 3], _)| {
        let own = |one: &Named| {
            let line = one.submission.lines.iter().find(|l| key(l) == wanted);
            line.map_or("–".to_owned(), cell)
        };
        wanted.iter().cloned().chain(all.iter().map(own)).collect()
    };
    Table::new(header, keys.map(record).collect())
}

/// The shaders of all submissions, with the statistics that any of them has.
fn shaders(all: &[Named]) -> Table {
    let each = || {
        all.iter()
            .flat_map(|one| one.submission.shaders.iter().map(move |s| (one, s)))
    };
    let mut names: Vec<&String> = each().flat_map(|(_, s)| s.statistics.keys()).collect();
    names.sort();
    names.dedup();
    let fixed = [
        "submission",
        "solver",
        "stage",
        "path",
        "shader",
        "subgroup",
    ];
    let header = fixed.into_iter().chain(names.iter().map(|n| n.as_str()));
    let record = |(one, s): (&Named, &super::OneShader)| {
        let words = [&one.label, &s.solver, &s.stage, &s.path, &s.shader].map(Clone::clone);
        let value = |name: &&String| {
            let value = s.statistics.get(*name);
            value.map_or("–".to_owned(), |v| number(*v, 6))
        };
        let numbers = std::iter::once(s.subgroup_size.to_string()).chain(names.iter().map(value));
        words.into_iter().chain(numbers).collect()
    };
    Table::new(header, each().map(record).collect())
}

/// Charts of ratios: a heading for each method and stage, a line for each device.
fn charts(all: &[Named]) -> Vec<Figure> {
    let places = || all.iter().enumerate();
    let lines = places().flat_map(|(place, one)| main_lines(one).map(move |line| (place, line)));
    // The baseline's own ratio in the fragment stage is 1.
    let lines = lines.filter(|(_, l)| !(l.method == RBM_BASELINE && l.stage == "fragment"));
    let placed = |(place, line): (usize, &Line)| -> Placed {
        let [value, low, high] = line.ratio;
        let value = Interval::new(value, low, high);
        let heading = format!("{}, {} stage", line.method, line.stage);
        let dot = dots::Line {
            name: all[place].label.clone(),
            value,
            style: Style {
                filled: line.stage == "fragment",
                ..Style::numbered(place)
            },
            unresolved: value.relative() > RESOLVED,
        };
        ((heading.clone(), heading), dot)
    };
    let groups = grouped(lines.map(placed), |placed| placed.0.1.clone()).into_iter();
    let lines: Vec<Placed> = groups.flat_map(|(_, lines)| lines).collect();
    let title = format!("Time of a frame by device, {RBM_BASELINE} being 1");
    let axis = format!("time / {RBM_BASELINE}");
    dots::pages(&title, &axis, Some(1.0), &lines)
}
