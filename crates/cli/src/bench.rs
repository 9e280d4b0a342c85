//! `revmap bench`: frame rates, step counts and errors, measured side by side.

use super::interrupt;
use super::lists::Lists;
use super::options::named;
use super::output;
use super::progress::Progress;
use clap::Args;
use revmap::error::{Error, ErrorKind, Result};
use revmap::gpu::Device;
use revmap::settings::DrawStage;
use revmap_lab::method::{Method, MethodSettings};
use revmap_lab::renderer::MethodDevice;
use revmap_lab::report::machine::Machine;
use revmap_lab::report::measure::{Measured, Observer, RenderedCase, TimeBudget, measure};
use revmap_lab::report::pictures::Album;
use revmap_lab::report::plan::{self, Axes, Labels, Plan, is_rbm_baseline};
use revmap_lab::report::scaling::Ranges;
use revmap_lab::report::suite::{self, Extent};
use revmap_lab::report::view::View;
use revmap_lab::report::{
    DeviceBench, antialiasing, budget, compare_runs, crowds, folder, overview, papers, scaling,
    text,
};
use std::path::PathBuf;

/// Makes views of other techniques.
type Techniques = fn(&[View]) -> Result<Vec<View>>;

const TECHNIQUES: [(&str, Techniques); 2] = [
    ("usual", suite::techniques),
    ("tables", papers::all_techniques),
];

/// Measures frame rates, step counts and errors; writes results.csv, report.html and pictures
#[derive(Args)]
#[command(after_help = "Examples:\n  \
    revmap bench --quick --out out/bench\n  \
    revmap bench assets/scenes/vase.toml --solver exact,live,mesh:64x128 --size 800x600,1920x1080\n  \
    revmap bench --compare results/old results/new")]
pub struct Bench {
    #[command(flatten)]
    lists: Lists,
    /// A look within 20 seconds: one solid unless scenes are named
    #[arg(long, conflicts_with = "full")]
    quick: bool,
    /// The whole suite from three elevations at two sizes, every search, five meshes: takes about
    /// an hour on two cores, above two with --framing whole,close
    #[arg(long)]
    full: bool,
    /// The published tables of frame rates: extended, beveled and chamfered solids at two sizes,
    /// rates beside the published ones
    #[arg(long, conflicts_with_all = ["full", "scenes", "framing"])]
    tables: bool,
    /// How time grows with pixels, with solids and with rows of the map
    #[arg(long, conflicts_with_all = ["full", "scenes", "size", "framing", "tables"])]
    scaling: bool,
    /// What a tolerance costs: errors and times of ten scenes at five tolerances
    #[arg(long, conflicts_with_all = ["full", "scenes", "size", "solver", "tolerance", "framing", "tables", "scaling"])]
    budget: bool,
    /// Crowds: a hundred to a million copies of ten solids beside one, and a flight through them
    #[arg(long, conflicts_with_all = ["full", "scenes", "size", "solver", "tolerance", "framing", "tables", "scaling", "budget"])]
    crowds: bool,
    /// Anti-aliasing: eight solids by one ray per pixel, with smoothed silhouettes and by several
    /// rays, against 64 rays
    #[arg(long, conflicts_with_all = ["full", "scenes", "size", "solver", "tolerance", "framing", "tables", "scaling", "budget", "crowds"])]
    antialiasing: bool,
    /// The solids by every technique. usual: plain, extended, beveled, chamfered, textured; tables:
    /// plain and by every value of the published tables, whole and cut by the box
    #[arg(long, value_name = "WHICH", num_args = 0..=1, default_missing_value = "usual", value_parser = named(&TECHNIQUES), conflicts_with_all = ["full", "tables", "scaling", "budget", "crowds", "antialiasing"])]
    techniques: Option<Techniques>,
    /// Prints a table of the default search in the runs of these folders: a row for each technique,
    /// a column for each driver; measures nothing
    #[arg(long, num_args = 1.., value_name = "DIR", conflicts_with_all = ["full", "quick", "scenes", "tables", "scaling", "budget", "crowds", "antialiasing", "techniques", "compare"])]
    drivers: Vec<PathBuf>,
    /// Holds the results in folder NEW against those in folder OLD; measures nothing
    #[arg(long, num_args = 2, value_names = ["OLD", "NEW"], conflicts_with_all = ["full", "quick", "scenes", "tables", "scaling", "budget", "crowds", "antialiasing"])]
    compare: Vec<PathBuf>,
}

impl Bench {
    pub fn run(self) -> Result<()> {
        self.lists.check()?;
        if let [old, new] = self.compare.as_slice() {
            let found = compare_runs::compare(old, new)?;
            print(&compare_runs::as_text(&found));
            return Ok(());
        }
        if !self.drivers.is_empty() {
            print(&compare_runs::drivers::markdown(&self.drivers)?);
            return Ok(());
        }
        if self.tables {
            return self.tables();
        }
        if self.scaling {
            return self.scaling();
        }
        if self.budget {
            return self.budget();
        }
        if self.crowds {
            return self.crowds();
        }
        if self.antialiasing {
            return self.antialiasing();
        }
        let (budget, extent, elevations, sizes): (_, _, &[f64], &[(u32, u32)]) = if self.quick {
            (TimeBudget::QUICK, Extent::One, &[25.0], &[(800, 600)])
        } else if self.full {
            (
                TimeBudget::FULL,
                Extent::All,
                &[0.0, 25.0, 60.0],
                &papers::SIZES,
            )
        } else {
            (TimeBudget::DEFAULT, Extent::Three, &[25.0], &[(800, 600)])
        };
        let (methods, meshes): (&[Method], &[(u32, u32)]) = if self.quick {
            (&plan::FEW, &plan::MESHES[..1])
        } else if self.full {
            (&Method::ALL, &plan::ALL_MESHES)
        } else {
            (&plan::USUAL, &plan::MESHES)
        };
        let mut views = self.lists.views(extent, elevations)?;
        if let Some(techniques) = self.techniques {
            views = techniques(&views)?;
        }
        let axes = self.axes(sizes, methods);
        let mut plan = Plan::new(views, &axes.combinations());
        if self.lists.solver.is_empty() {
            plan.add_meshes(meshes);
        }
        plan.add_rbm_baseline();
        plan.add_floors();
        let (session, measured, album) =
            self.measured(&plan, &budget, |s| s.method != Method::Floor, &mut |_| {})?;
        overview::write(&session.out, &plan, &measured, &session.machine, &album)?;
        print(&text::summary(&measured.rows));
        session.finish(&plan, &measured)
    }

    fn axes(&self, sizes: &[(u32, u32)], methods: &[Method]) -> Axes {
        self.lists.axes(&Axes {
            sizes: sizes.to_vec(),
            methods: methods.to_vec(),
            ..Axes::default()
        })
    }

    /// Of runs that are not the suite's.
    fn limits(&self) -> TimeBudget {
        if self.quick {
            TimeBudget::QUICK
        } else {
            TimeBudget::CHART
        }
    }

    /// Measures a plan, and keeps its rows.
    fn measured(
        &self,
        plan: &Plan,
        budget: &TimeBudget,
        worth: fn(&MethodSettings) -> bool,
        also: &mut dyn FnMut(&RenderedCase),
    ) -> Result<(Session, Measured, Album)> {
        let session = Session::open(&self.lists)?;
        let budget = self.lists.time_budget(budget);
        let (measured, album) = session.measure(plan, &budget, worth, also)?;
        folder::write(&session.out, plan, &measured, &session.machine)?;
        Ok((session, measured, album))
    }

    /// The published tables. The solid is one that the program carries: the articles do not name
    /// theirs.
    fn tables(&self) -> Result<()> {
        let mut plan = Plan::new(
            papers::views()?,
            &self.axes(&papers::SIZES, &plan::USUAL).combinations(),
        );
        plan.add_rbm_baseline();
        plan.add_floors();
        plan.mixed = true;
        let (session, measured, album) =
            self.measured(&plan, &self.limits(), is_rbm_baseline, &mut |_| {})?;
        papers::write(&session.out, &plan, &measured, &session.machine, &album)?;
        print(&papers::as_text(&measured.rows));
        session.finish(&plan, &measured)
    }

    fn budget(&self) -> Result<()> {
        let stages = self.axes(&[], &[]).stages;
        let plan = budget::plan(&stages, self.quick)?;
        let mut errors = budget::Errors::default();
        let (session, measured, _) =
            self.measured(&plan, &self.limits(), |_| false, &mut |seen| {
                errors.add(seen)
            })?;
        budget::write(&session.out, &plan, &measured, &errors, &session.machine)?;
        print(&budget::as_text(&measured.rows, &errors));
        session.finish(&plan, &measured)
    }

    fn crowds(&self) -> Result<()> {
        let stages = self.axes(&[], &[]).stages;
        let (numbers, flown) = if self.quick {
            (crowds::QUICK, &crowds::FLOWN_QUICK[..])
        } else {
            (crowds::COPIES.len(), &crowds::FLOWN[..])
        };
        let plan = crowds::plan(&stages, numbers)?;
        let (session, measured, _) =
            self.measured(&plan, &self.limits(), |_| false, &mut |_| {})?;
        let device = MethodDevice::new(session.device.clone())?;
        let fly = |stage: DrawStage, (solids, frames)| {
            crowds::fly(&device, &crowds::settings(stage), solids, frames, 10)
        };
        let all = flown
            .iter()
            .flat_map(|f| stages.iter().map(|s| fly(*s, *f)));
        let flights: Vec<_> = all.collect::<Result<_>>()?;
        crowds::write(&session.out, &plan, &measured, &flights, &session.machine)?;
        print(&crowds::as_text(&measured.rows, &flights));
        session.finish(&plan, &measured)
    }

    fn antialiasing(&self) -> Result<()> {
        let stages = self.axes(&[], &[]).stages;
        let (extent, rounds) = if self.quick {
            (Extent::One, 5)
        } else {
            (Extent::All, 25)
        };
        let rounds = self.lists.rounds.map_or(rounds, usize::from);
        let session = Session::open(&self.lists)?;
        let device = MethodDevice::new(session.device.clone())?;
        let progress = Progress::start("measuring", session.quiet);
        let say = |done, all| progress.report(done, all);
        let (lines, sheets) = antialiasing::measure(&device, &stages, extent, rounds, &say)?;
        drop(progress);
        antialiasing::write(&session.out, &lines, &sheets, rounds, &session.machine)?;
        print(&antialiasing::as_text(&lines));
        let report = session.out.join("report.html");
        output::result(&format!("{}: {} rows", report.display(), lines.len()));
        Ok(())
    }

    fn scaling(&self) -> Result<()> {
        let mut axes = self.axes(&[], &plan::USUAL);
        if self.lists.solver.is_empty() {
            let mesh = |(segments, rings)| Method::Mesh { segments, rings };
            axes.methods.extend(scaling::MESHES.map(mesh));
        }
        let ranges = if self.quick {
            Ranges::QUICK
        } else {
            Ranges::ALL
        };
        let plan = scaling::plan(&axes.stages, &axes.methods, ranges)?;
        let (session, measured, _) =
            self.measured(&plan, &self.limits(), |_| false, &mut |_| {})?;
        scaling::write(&session.out, &plan, &measured, &session.machine)?;
        print(&scaling::as_text(&measured.rows));
        session.finish(&plan, &measured)
    }
}

/// Results, line by line.
fn print(text: &str) {
    text.lines().for_each(output::result);
}

/// A device, a folder and a note on the machine.
pub struct Session {
    pub device: Device,
    pub machine: Machine,
    pub out: PathBuf,
    pub quiet: bool,
}

impl Session {
    /// Opens the device and makes the folder before any work.
    pub fn open(lists: &Lists) -> Result<Self> {
        let device = Device::open(lists.device.as_deref())?;
        let report = device.report();
        let machine = Machine::here(&report.name, report.kind, &report.driver, &Lists::command());
        let out = lists.folder(&machine.folder())?;
        if !lists.quiet {
            output::note(&format!(
                "device: {} ({}), driver {}",
                report.name, report.kind, report.driver
            ));
        }
        Ok(Self {
            device,
            machine,
            out,
            quiet: lists.quiet,
        })
    }

    /// Measures with a progress bar, with heat maps of the ways that are `worth` one; an interrupt
    /// ends early and keeps what there is. `also` is shown every picture.
    pub fn measure(
        &self,
        plan: &Plan,
        budget: &TimeBudget,
        worth: fn(&MethodSettings) -> bool,
        also: &mut dyn FnMut(&RenderedCase),
    ) -> Result<(Measured, Album)> {
        let labels = Labels::new(plan.cases.iter().map(|c| &c.settings));
        let mut album = Album::new(&self.out, labels, worth)?;
        let progress = Progress::start("measuring", self.quiet);
        let mut bench = DeviceBench::new(self.device.clone())?;
        let measured = measure(
            plan,
            &mut bench,
            budget,
            &mut Observer {
                stop: interrupt::flag()?,
                progress: &|what, gone, all| {
                    progress.say(what);
                    progress.report(gone as usize, all as usize);
                },
                picture: &mut |seen| {
                    also(seen);
                    album.add(seen)
                },
                passed: &mut |rows| folder::write_rows(&self.out, rows, &self.machine),
            },
        )?;
        Ok((measured, album))
    }

    /// Says where the results are. A run that was ended early has failed, though its results are
    /// kept.
    pub fn finish(&self, plan: &Plan, measured: &Measured) -> Result<()> {
        if !self.quiet {
            for view in &plan.views {
                let size = plan
                    .cases
                    .first()
                    .map(|c| (c.settings.width, c.settings.height));
                let (width, height) = size.unwrap_or((800, 600));
                for warning in view.scene.warnings(width, height) {
                    output::warn(&format!("{}: {warning}", view.name));
                }
            }
        }
        let report = self.out.join("report.html");
        output::result(&format!(
            "{}: {} rows",
            report.display(),
            measured.rows.len()
        ));
        if measured.interrupted {
            return Err(Error::new(
                ErrorKind::Other,
                "interrupted; it holds what was measured until then, run the command again for the rest",
            )
            .in_file(&self.out));
        }
        Ok(())
    }
}
