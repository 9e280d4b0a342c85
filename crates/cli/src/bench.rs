//! `revmap bench`: frame rates, step counts and errors, measured side by side. `revmap chart`: speed
//! against accuracy.

use super::lists::Lists;
use super::options::named;
use super::output;
use super::progress::{Progress, interrupted};
use super::run::{Results, Run};
use clap::Args;
use revmap::error::{Error, ErrorKind, Result};
use revmap::settings::DrawStage;
use revmap_bench::compare::repeat::Verdict;
use revmap_bench::compare::{self, submission};
use revmap_bench::measure::device::DeviceBench;
use revmap_bench::measure::{Measured, Observer, measure};
use revmap_bench::plan::Plan;
use revmap_bench::plan::method::renderer::MethodDevice;
use revmap_bench::report;
use revmap_bench::report::flight::{self, FlightTimes};
use revmap_bench::report::folder;
use revmap_bench::report::pictures::{Album, Sheets};
use revmap_bench::report::plan_file::{PlanFile, embedded};
use revmap_bench::report::series_style::SeriesStyles;
use revmap_searches::folder::of as of_folder;
use std::path::{Path, PathBuf};

/// Plans of other techniques.
const TECHNIQUES: [(&str, &str); 2] = [("usual", "techniques"), ("tables", "techniques-tables")];

/// Measures frame rates, step counts and errors; writes results.csv, report.html and pictures
///
/// A plan says what is measured and shown. Without one the program takes its own, named usual.
#[derive(Args)]
#[command(after_help = "Examples:\n  \
    revmap bench --quick --out out/bench\n  \
    revmap bench assets/scenes/vase.toml --solver exact,live,mesh:0.25px --size 800x600,1920x1080\n  \
    revmap bench --list scaling > mine.toml && revmap bench --plan mine.toml\n  \
    revmap bench --compare results/old results/new\n  \
    revmap bench --gather mine.toml yours.toml --out out/devices")]
pub struct Bench {
    #[command(flatten)]
    lists: Lists,
    #[command(flatten)]
    scale: Scale,
    #[command(flatten)]
    what: What,
    #[command(flatten)]
    how: How,
}

/// Charts speed against accuracy: every search over its budget and its maps
///
/// Steps, rows, sources and formats of maps are swept one at a time; where one of their lists is
/// given, every combination of the lists is measured instead.
#[derive(Args)]
#[command(after_help = "Examples:\n  \
    revmap chart --quick --out out/chart\n  \
    revmap chart assets/scenes/vase.toml --solver circle,live --max-steps 10,20,40,80")]
pub struct Chart {
    #[command(flatten)]
    lists: Lists,
    #[command(flatten)]
    scale: Scale,
}

impl Chart {
    pub fn run(self) -> Result<()> {
        let full = self.scale.full;
        let name = if full { "chart-full" } else { "chart" };
        run(embedded::plan(name)?, &self.lists, self.scale.quick)
    }
}

/// How much is measured.
#[derive(Args)]
struct Scale {
    /// A quick look: fewer solids, methods and values. Without another plan: one solid, within 20
    /// seconds
    #[arg(long, conflicts_with = "full")]
    quick: bool,
    /// The whole suite from three elevations, every search: takes above an hour on two cores
    #[arg(long)]
    full: bool,
}

/// The task; one of these at a time
#[derive(Args)]
#[group(id = "what", multiple = false, conflicts_with = "full")]
struct What {
    /// The plan in a TOML file
    #[arg(long, value_name = "FILE")]
    plan: Option<PathBuf>,
    /// Prints the program's plans, or the file of one of them; measures nothing
    #[arg(long, value_name = "PLAN", num_args = 0..=1, default_missing_value = "")]
    list: Option<String>,
    /// The published tables of frame rates: extended, beveled and chamfered solids at two sizes,
    /// rates beside the published ones
    #[arg(long)]
    tables: bool,
    /// How time grows with pixels, with solids and with rows of the map
    #[arg(long)]
    scaling: bool,
    /// The cost of a tolerance: errors and times of ten scenes at five tolerances
    #[arg(long)]
    budget: bool,
    /// The default against the mesh of equal silhouettes over tolerances from 0 to 2 pixels, and
    /// where the two take the same time
    #[arg(long)]
    tolerances: bool,
    /// The default search against quadric and live from 64x48 to 800x600, with and without
    /// shadows: where it is the wrong choice
    #[arg(long)]
    sizes: bool,
    /// Crowds: a hundred to a million copies of ten solids against the mesh that follows the view,
    /// and flights through them
    #[arg(long)]
    crowds: bool,
    /// Solids whose offset moves, against the mesh made anew: the host's time beside the device's
    #[arg(long)]
    offsets: bool,
    /// Anti-aliasing: eight solids by one ray per pixel, with smoothed silhouettes and by several
    /// rays, against 64 rays
    #[arg(long)]
    antialiasing: bool,
    /// The solids by every technique. usual: plain, extended, beveled, chamfered, textured; tables:
    /// plain and by every value of the published tables, whole and cut by the box
    #[arg(long, value_name = "WHICH", num_args = 0..=1, default_missing_value = "usual", value_parser = named(&TECHNIQUES))]
    techniques: Option<&'static str>,
    /// Puts files of `revmap submit` side by side: a table and a chart across devices in the folder
    /// of --out; measures nothing
    #[arg(long, num_args = 1.., value_name = "FILE")]
    gather: Vec<PathBuf>,
    /// Compares the results in these folders; measures nothing. A table has a row for each
    /// technique and way of drawing, a column for each run. Of two runs, OLD and NEW, it names what
    /// became slower or faster, less or more exact
    #[arg(long, num_args = 2.., value_name = "DIR")]
    compare: Vec<PathBuf>,
}

/// How runs are compared.
#[derive(Args)]
struct How {
    /// With --compare OLD NEW: judge line by line whether NEW repeats what OLD says of these
    /// methods (exact, mesh:64x128, baseline), by the pictures that both have. Exit codes: 1 if NEW
    /// contradicts a claim; else 4 if a claim is not judged, because NEW lacks half of its pictures
    /// or its interval is too wide
    #[arg(
        long,
        requires = "compare",
        value_name = "METHOD,...",
        value_delimiter = ','
    )]
    repeats: Vec<String>,
}

impl Bench {
    pub fn run(self) -> Result<()> {
        let what = &self.what;
        match (what.compare.as_slice(), self.how.repeats.is_empty()) {
            ([], _) => {}
            ([old, new], false) => return repeats(old, new, &self.how.repeats),
            (_, false) => {
                let message = "judges one run by another; give --compare OLD NEW";
                return Err(Error::new(ErrorKind::Usage, message).at_key("--repeats"));
            }
            (folders, true) => {
                let found = compare::compare(folders)?;
                found.warnings.iter().for_each(|text| output::warn(text));
                print(&compare::as_text(&found, output::width()));
                return Ok(());
            }
        }
        if !what.gather.is_empty() {
            return gather(&what.gather, &self.lists);
        }
        if let Some(name) = &what.list {
            return list(name);
        }
        let file = match &what.plan {
            Some(file) => PlanFile::load(file)?,
            None => embedded::plan(self.name())?,
        };
        run(file, &self.lists, self.scale.quick)
    }

    /// The name of the program's own plan.
    fn name(&self) -> &'static str {
        let what = &self.what;
        let named = [
            (what.tables, "tables"),
            (what.scaling, "scaling"),
            (what.budget, "budget"),
            (what.tolerances, "tolerances"),
            (what.sizes, "sizes"),
            (what.crowds, "crowds"),
            (what.offsets, "offsets"),
            (what.antialiasing, "antialiasing"),
            (self.scale.full, "full"),
        ];
        let found = named.iter().find(|(given, _)| *given);
        let usual = if self.scale.quick { "quick" } else { "usual" };
        let found = found.map(|(_, name)| *name);
        found.or(what.techniques).unwrap_or(usual)
    }
}

/// The exit code if no claim is contradicted, and some are not judged.
const NOT_JUDGED: u8 = 4;

/// Judges whether a new run repeats a kept one.
fn repeats(old: &Path, new: &Path, methods: &[String]) -> Result<()> {
    let (claims, warnings) = compare::repeat::claims(old, new, methods)?;
    warnings.iter().for_each(|text| output::warn(text));
    print(&compare::repeat::as_text(&claims));
    let has = |verdict| claims.iter().any(|claim| claim.0 == verdict);
    if has(Verdict::NotRepeated) {
        let message = "contradicts what the kept run says; see the lines that begin with NOT";
        return Err(Error::new(ErrorKind::Content, message).in_file(new));
    }
    if has(Verdict::NotJudged) {
        output::end_with(NOT_JUDGED);
    }
    Ok(())
}

/// Puts submissions side by side.
fn gather(files: &[PathBuf], lists: &Lists) -> Result<()> {
    let all = submission::gather::load(files)?;
    submission::gather::warnings(&all)
        .iter()
        .for_each(|text| output::warn(text));
    let out = lists.results.folder("submitted", files)?;
    print(&submission::gather::write(&all, &out, output::width())?);
    let (report, count) = (out.join("report.html"), all.len());
    output::result(&format!("{}: {count} submissions", report.display()));
    Ok(())
}

fn list(name: &str) -> Result<()> {
    if !name.is_empty() {
        print(embedded::text(name)?);
        return Ok(());
    }
    for (name, about) in embedded::list()? {
        output::result(&format!("{name:<18} {about}"));
    }
    Ok(())
}

/// Measures a plan with what the command line changes in it, and writes its report.
fn run(mut file: PlanFile, lists: &Lists, quick: bool) -> Result<()> {
    lists.check()?;
    let given = lists.overrides(quick)?;
    file.apply(&given);
    let plan = file.plan(&given)?;
    let session = Session {
        run: lists.results.begin(|| lists.files())?,
        results: &lists.results,
    };
    let (measured, mut album) = session.measure(&file, &plan)?;
    let (out, machine) = (&session.run.out, &session.run.machine);
    folder::write(out, &plan, &measured, machine, file.time.resolved)?;
    let flights = session.flights(&file, &given.lists.stages)?;
    album
        .shots
        .retain(|_| file.show.iter().any(|name| name == "shots"));
    let report = report::Run {
        file: &file,
        plan: &plan,
        measured: &measured,
        machine,
        album: &album,
        flights: &flights,
    };
    print(report.write(out, output::width())?.trim_end());
    let summary = out.join("charts/summary-depth-error.svg");
    if summary.exists() {
        output::result(&summary.display().to_string());
    }
    session.finish(&plan, &measured)
}

/// Results, line by line.
fn print(text: &str) {
    text.lines().for_each(output::result);
}

/// A run and the options of its results.
struct Session<'a> {
    run: Run,
    results: &'a Results,
}

impl Session<'_> {
    /// Measures with a progress bar; an interrupt ends early and keeps what there is.
    fn measure(&self, file: &PlanFile, plan: &Plan) -> Result<(Measured, Album)> {
        let styles = SeriesStyles::new(plan.cases.iter().map(|c| &c.settings));
        let mut album = Album::new(&self.run.out, styles, file.heat_maps)?;
        let mut sheets = (file.truth_rays > 1).then(|| Sheets::new(&self.run.out));
        let progress = Progress::start("measuring", self.results.quiet);
        let mut bench = DeviceBench::new(self.run.device.clone(), !file.wall_clock)?;
        let mut observer = Observer {
            stop: self.run.stop,
            progress: &|what, gone, all| {
                progress.say(what);
                progress.report(gone as usize, all as usize);
            },
            picture: &mut |seen| {
                if let Some(sheets) = &mut sheets {
                    sheets.add(seen)?;
                }
                album.add(seen)
            },
            passed: &mut |rows| match rows {
                [] => Ok(()),
                _ => folder::write_rows(
                    &self.run.out,
                    rows,
                    plan,
                    &self.run.machine,
                    file.time.resolved,
                ),
            },
        };
        let measured = measure(plan, &mut bench, &file.time, &mut observer);
        if measured.is_err() && !self.run.out.join("results.csv").exists() {
            folder::discard(&self.run.out, self.run.made)?;
        }
        let measured = measured?;
        if let Some(sheets) = &mut sheets {
            sheets.finish()?;
        }
        Ok((measured, album))
    }

    /// Flies through the plan's armies, in each stage, and writes the times of every frame.
    fn flights(&self, file: &PlanFile, stages: &[DrawStage]) -> Result<Vec<FlightTimes>> {
        if file.flights.is_empty() {
            return Ok(Vec::new());
        }
        let device = MethodDevice::new(self.run.device.clone())?;
        let stages = match stages {
            [] => &[DrawStage::Fragment, DrawStage::Compute],
            stages => stages,
        };
        let mut all = Vec::new();
        for plan in &file.flights {
            for &stage in stages {
                let settings = flight::settings(stage);
                let own = flight::fly(&device, &settings, plan)?;
                let name = format!("{}.csv", own.name());
                folder::write_text(&self.run.out.join(name), &own.table().csv())?;
                all.push(own);
            }
        }
        Ok(all)
    }

    /// Prints where the results are. A run that was ended early has failed, though its results are
    /// kept.
    fn finish(&self, plan: &Plan, measured: &Measured) -> Result<()> {
        if !self.results.quiet {
            let first = plan.cases.first().map(|c| c.settings);
            let size = first.map(|s| (s.width, s.height));
            let (width, height) = size.unwrap_or((800, 600));
            for view in &plan.views {
                for warning in revmap_files::warnings(&view.scene, width, height) {
                    output::warn(&format!("{}: {warning}", view.name));
                }
            }
        }
        // What the device or a scene excludes is in the report alone, unless nothing else is left.
        let mut failed = Vec::new();
        for (case, reason) in &measured.left_out {
            let method = case.settings.method;
            let is_of_folder = method.solver().and_then(of_folder).is_some();
            let is_missing = || measured.rows.iter().all(|r| r.settings.method != method);
            if !failed.contains(&(method, reason)) && (is_of_folder || is_missing()) {
                failed.push((method, reason));
                output::warn(&format!("{method} was left out: {reason}"));
            }
        }
        if let Some(warning) = folder::clock_warning(&measured.rows) {
            output::warn(&warning);
        }
        let (report, rows) = (self.run.out.join("report.html"), measured.rows.len());
        output::result(&format!("{}: {rows} rows", report.display()));
        if !measured.interrupted {
            return Ok(());
        }
        Err(interrupted(&self.run.out, self.results.out.is_some()))
    }
}
