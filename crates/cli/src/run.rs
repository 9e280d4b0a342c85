//! Runs that fill a folder of results.

use super::options::DeviceChoice;
use super::{output, overrun, progress};
use clap::Args;
use revmap::error::Result;
use revmap::gpu::Device;
use revmap_bench::measure::machine::Machine;
use revmap_bench::report::folder;
use std::path::{Path, PathBuf};
use std::sync::atomic::AtomicBool;

/// Where a run draws and what it leaves
#[derive(Args, Clone, Debug)]
pub struct Results {
    #[command(flatten)]
    pub device: DeviceChoice,
    /// The folder for results [default: results/DATE-DEVICE, made anew]
    #[arg(long, short, value_name = "DIR")]
    pub out: Option<PathBuf>,
    /// Replace the run that the folder of --out holds
    #[arg(long, requires = "out")]
    pub overwrite: bool,
    /// Say nothing but results and failures
    #[arg(long, short)]
    pub quiet: bool,
}

/// A device, a folder and a note on the machine.
pub struct Run {
    pub device: Device,
    pub machine: Machine,
    pub out: PathBuf,
    /// True if `out` was not there before.
    pub made: bool,
    /// Set by an interrupt.
    pub stop: &'static AtomicBool,
}

impl Results {
    /// The folder, or one made for results of this name. None may be written over the `inputs`.
    ///
    /// # Errors
    /// See [`folder::claim`].
    pub fn folder(&self, name: &str, inputs: &[PathBuf]) -> Result<PathBuf> {
        let Some(out) = &self.out else {
            return folder::fresh(Path::new("results"), name);
        };
        let inputs = inputs.iter().map(PathBuf::as_path);
        folder::claim(out, self.overwrite || overrun::is_again(), inputs)?;
        Ok(out.clone())
    }

    /// Opens the device and makes the folder before any work. The `inputs` are read if a folder was
    /// named.
    pub fn begin(&self, inputs: impl FnOnce() -> Result<Vec<PathBuf>>) -> Result<Run> {
        let device = self.device.open()?;
        let report = device.report();
        let machine = output::machine(report, &command());
        // From here on an early end leaves no empty folder.
        let stop = progress::interrupt()?;
        let made = !self.out.as_ref().is_some_and(|out| out.exists());
        let inputs = self.out.as_ref().map_or(Ok(Vec::new()), |_| inputs())?;
        let out = self.folder(&machine.folder(), &inputs)?;
        overrun::keep_folder(&out);
        overrun::try_out(self.device.name());
        if !self.quiet {
            output::device(report);
        }
        Ok(Run {
            device,
            machine,
            out,
            made,
            stop,
        })
    }
}

/// A command that measures the same again, told by its words.
fn command() -> String {
    let quote = |word: String| {
        let plain = |c: char| c.is_ascii_alphanumeric() || "-_=.,/:@+%".contains(c);
        match !word.is_empty() && word.chars().all(plain) {
            true => word,
            false => format!("'{}'", word.replace('\'', "'\\''")),
        }
    };
    let given = std::env::args_os().skip(1);
    let given = given.map(|word| quote(word.to_string_lossy().into_owned()));
    let words: Vec<_> = ["revmap".to_owned()].into_iter().chain(given).collect();
    words.join(" ")
}
