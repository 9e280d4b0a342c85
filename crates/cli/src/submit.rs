//! `revmap submit`: the figures of this device in a small file, for others to gather.

use super::options::{DeviceChoice, size};
use super::output::{self, Outputs};
use super::progress::{Progress, interrupt};
use super::shaders;
use clap::Args;
use revmap::error::{Error, ErrorKind, Result};
use revmap::gpu::Device;
use revmap_bench::compare::submission::{self, OneShader, Pictures};
use revmap_bench::measure::device::DeviceBench;
use revmap_bench::measure::{Measured, Observer, measure};
use revmap_bench::plan::{Lists, Overrides, Plan};
use revmap_bench::report::folder;
use revmap_bench::report::plan_file::{PlanFile, embedded};
use std::path::PathBuf;

/// Pixels of each picture on a software device, and on a GPU, whose frames would be too short otherwise.
const SIZES: [(u32, u32); 2] = [(800, 600), (1920, 1080)];

/// The plan's name, as --quick measures it or not.
const PLANS: [&str; 2] = ["submit", "submit --quick"];

/// Measures this device in less than five minutes and writes its figures into one small file
///
/// The file is text. It names device, driver, processor and system, and holds times, errors and what
/// the driver's compiler says. It holds no name of a person or machine and no path. `revmap bench
/// --gather` makes a table of several files.
#[derive(Args)]
#[command(after_help = "Examples:\n  \
    revmap submit -o my-device.toml\n  \
    revmap submit -o intel.toml --device intel\n  \
    revmap bench --gather my-device.toml intel.toml --out out/devices")]
pub struct Submit {
    /// The file, ending in .toml
    #[arg(long, short, value_name = "FILE.toml")]
    output: PathBuf,
    /// Pixels of each picture [default: 800x600 on software devices, 1920x1080 on GPUs]
    #[arg(long, value_name = "WIDTHxHEIGHT", value_parser = size)]
    size: Option<(u32, u32)>,
    /// A quick look at one solid, to try the command; send a file that was made without it
    #[arg(long)]
    quick: bool,
    #[command(flatten)]
    device: DeviceChoice,
    /// Say nothing but results and failures
    #[arg(long, short)]
    quiet: bool,
}

impl Submit {
    pub fn run(self) -> Result<()> {
        let file = Outputs::default().and("--output", [&self.output], &["toml"]);
        file.check(&[])?;
        let device = self.device.open()?;
        let report = device.report().clone();
        if !self.quiet {
            output::device(&report);
        }
        let machine = output::machine(&report, "revmap submit");
        let given = Overrides {
            quick: self.quick,
            lists: Lists {
                sizes: vec![
                    self.size
                        .unwrap_or(SIZES[usize::from(report.kind != "cpu")]),
                ],
                ..Lists::default()
            },
            ..Overrides::default()
        };
        let mut file = embedded::plan(PLANS[0])?;
        file.apply(&given);
        let plan = file.plan(&given)?;
        let mut pictures = Pictures::default();
        let measured = self.measure(device, &file, &plan, &mut pictures)?;
        let shaders = self.shaders()?;
        let named = (PLANS[usize::from(self.quick)], &plan);
        let of = (&machine, &report);
        let submission = submission::make(named, &measured, of, &pictures, shaders)?;
        folder::write_text(&self.output, &submission.text()?)?;
        let warning = folder::clock_warning(&measured.rows);
        if let Some(warning) = warning.filter(|_| report.kind == "cpu") {
            output::warn(&warning);
        }
        let (lines, rows) = (submission.lines.len(), submission.pictures.len());
        let file = self.output.display();
        output::result(&format!("{file}: {lines} lines, {rows} pictures"));
        Ok(())
    }

    /// Measures all of the plan: a part of it would not compare with other submissions.
    fn measure(
        &self,
        device: Device,
        file: &PlanFile,
        plan: &Plan,
        pictures: &mut Pictures,
    ) -> Result<Measured> {
        let progress = Progress::start("measuring", self.quiet);
        let mut bench = DeviceBench::new(device, true)?;
        let mut observer = Observer {
            stop: interrupt()?,
            progress: &|what, gone, all| {
                progress.say(what);
                progress.report(gone as usize, all as usize);
            },
            picture: &mut |seen| pictures.add(seen),
            passed: &mut |_| Ok(()),
        };
        let measured = measure(plan, &mut bench, &file.time, &mut observer)?;
        if measured.interrupted {
            let message = "interrupted, and nothing was written; run the command again";
            return Err(Error::new(ErrorKind::Other, message).in_file(&self.output));
        }
        if let Some((case, reason)) = measured.left_out.first() {
            let what = case.settings.method;
            output::warn(&format!("{what} was left out: {reason}"));
        }
        Ok(measured)
    }

    /// What the driver's compiler says; nothing if it has no words for it.
    fn shaders(&self) -> Result<Vec<OneShader>> {
        match shaders::plain(self.device.name()) {
            Err(error) if error.kind == ErrorKind::Unsupported => Ok(Vec::new()),
            said => said,
        }
    }
}
