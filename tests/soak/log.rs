//! The actions of an episode, and what they found.

use std::collections::BTreeMap;
use std::fmt::{self, Display};
use std::fs::File;
use std::io::Write;
use std::path::PathBuf;

/// A fault of the library, in words.
#[derive(Debug)]
pub struct Finding(pub String);

impl Display for Finding {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.0)
    }
}

impl From<revmap::Error> for Finding {
    fn from(error: revmap::Error) -> Self {
        Self(format!("a valid call failed: {error}"))
    }
}

/// Fails with a text.
pub fn found<T>(text: impl Into<String>) -> Result<T, Finding> {
    Err(Finding(text.into()))
}

/// Counts of what was done, over all episodes of a run.
#[derive(Default)]
pub struct Tally(BTreeMap<String, u64>);

impl Tally {
    pub fn count(&mut self, what: impl Into<String>, by: u64) {
        *self.0.entry(what.into()).or_default() += by;
    }

    pub fn of(&self, what: &str) -> u64 {
        self.0.get(what).copied().unwrap_or_default()
    }

    pub fn add(&mut self, other: Self) {
        other
            .0
            .into_iter()
            .for_each(|(what, n)| self.count(what, n));
    }
}

impl Display for Tally {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let each = self.0.iter().map(|(what, n)| format!("{what} {n}"));
        f.write_str(&each.collect::<Vec<_>>().join(", "))
    }
}

/// The actions of an episode, in a file, which outlives a crash. Its end is printed if the thread
/// panics.
pub struct Log {
    seed: u64,
    path: PathBuf,
    file: File,
    pub tally: Tally,
}

/// Number of actions that a failure prints.
const LAST: usize = 40;

impl Log {
    pub fn new(seed: u64) -> Self {
        let path = PathBuf::from(env!("CARGO_TARGET_TMPDIR"));
        let path = path.join(format!("soak-{seed}-{}.txt", std::process::id()));
        Self {
            seed,
            file: File::create(&path).unwrap(),
            path,
            tally: Tally::default(),
        }
    }

    /// Keeps an action.
    pub fn note(&mut self, action: impl Display) {
        let _ = writeln!(self.file, "{action}");
    }

    /// The last actions, one a line.
    pub fn text(&self) -> String {
        let text = std::fs::read_to_string(&self.path).unwrap_or_default();
        let lines: Vec<_> = text.lines().collect();
        let last = lines[lines.len().saturating_sub(LAST)..].iter();
        let last = last.map(|one| format!("  - {one}\n"));
        let all = self.path.display();
        format!(
            "the last actions (all are in {all}):\n{}",
            last.collect::<String>()
        )
    }

    /// Removes the file of an episode without a fault.
    pub fn forget(&self) {
        let _ = std::fs::remove_file(&self.path);
    }
}

impl Drop for Log {
    fn drop(&mut self) {
        if std::thread::panicking() {
            let (seed, text) = (self.seed, self.text());
            eprintln!("REVMAP_SOAK_SEED={seed} repeats it; {text}");
        }
    }
}
