//! The file of a plan: its keys, its faults, and what the command line changes in it. Those of the
//! program's own are [`embedded`] in it.

pub mod embedded;

use crate::plan::{Measure, Overrides, Plan, TimeBudget, Views};
use crate::report::exhibit::{self, Exhibit};
use revmap::error::{Error, ErrorKind, Result};
use revmap_figures::table::text_of;
use std::path::Path;

/// A plan as its file has it. `docs/benchmarks.md` explains the keys.
#[derive(Clone, Debug, serde::Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PlanFile {
    /// One sentence: what the plan measures.
    pub about: String,
    /// Title of the report.
    pub title: String,
    /// How long, and how often.
    #[serde(default)]
    pub time: TimeBudget,
    /// The views.
    pub views: Vec<Views>,
    /// How it is drawn: every combination of the lists of each entry.
    pub measure: Vec<Measure>,
    /// Entries in place of `measure` where the command line lists bounds on steps or maps.
    pub combinations: Option<Vec<Measure>>,
    /// Flights through armies.
    #[serde(default)]
    pub flights: Vec<Flight>,
    /// Names of the tables and charts of the report, in their order.
    pub show: Vec<String>,
    /// Tables and charts of the plan's own.
    #[serde(default)]
    pub exhibit: Vec<Exhibit>,
    /// True if all views of one size are drawn in turn, not each view by itself.
    #[serde(default)]
    pub mixed: bool,
    /// Rays per pixel of the picture that others are compared with; 1: the reference.
    #[serde(default = "one_ray")]
    pub truth_rays: u32,
    /// True if errors are measured in pixels too.
    #[serde(default)]
    pub pixel_errors: bool,
    /// True if times are those of the wall clock, also where the device has a clock.
    #[serde(default)]
    pub wall_clock: bool,
    /// True if heat maps are drawn.
    #[serde(default)]
    pub heat_maps: bool,
    /// The values for a quick look, in place of the keys above.
    pub quick: Option<Quick>,
}

fn one_ray() -> u32 {
    1
}

/// The values of a quick look, in place of the plan's own.
#[derive(Clone, Debug, Default, serde::Deserialize)]
#[serde(deny_unknown_fields, default)]
#[allow(missing_docs)] // as in [`PlanFile`]
pub struct Quick {
    pub time: Option<TimeBudget>,
    pub views: Option<Vec<Views>>,
    pub measure: Option<Vec<Measure>>,
    pub flights: Option<Vec<Flight>>,
}

/// A flight through an army: the default search with a tolerance, every frame timed.
#[derive(Clone, Debug, serde::Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Flight {
    /// Copies.
    pub copies: u32,
    /// Frames.
    pub frames: usize,
    /// Each of so many pictures is compared with an exact one.
    #[serde(default = "tenth")]
    pub compared: usize,
    /// All copies move in each frame, and the camera stands still.
    #[serde(default)]
    pub copies_move: bool,
}

fn tenth() -> usize {
    10
}

impl PlanFile {
    /// Reads a plan.
    ///
    /// # Errors
    /// [`ErrorKind::Content`], naming the line and the key: an unknown key, a missing one, a value
    /// that is not allowed, a name that is not there.
    pub fn parse(text: &str) -> Result<Self> {
        let plan: Self = toml::from_str(text).map_err(|e| fault(text, &e))?;
        plan.check()?;
        Ok(plan)
    }

    /// Reads the plan in a file.
    pub fn load(file: &Path) -> Result<Self> {
        let text = text_of(file, "give a plan, `revmap bench --list` shows some")?;
        Self::parse(&text).map_err(|e| e.in_file(file))
    }

    /// Names that lead nowhere, and lists that leave nothing to measure.
    fn check(&self) -> Result<()> {
        let quick = self.quick.as_ref().and_then(|q| q.measure.as_ref());
        let others = [quick, self.combinations.as_ref()].into_iter().flatten();
        let all = self.measure.iter().chain(others.flatten());
        let all: Vec<&Measure> = all.collect();
        let views: Vec<&str> = self.views.iter().map(|v| v.name.as_str()).collect();
        let sweeps: Vec<&str> = all.iter().map(|m| m.name.as_str()).collect();
        for measure in &all {
            for name in &measure.views {
                known("views", name, &views, "the names of [[views]]")?;
            }
        }
        let exhibits = exhibit::all(&self.exhibit)?;
        let names: Vec<&str> = exhibits.iter().map(|e| e.name.as_str()).collect();
        for name in &self.show {
            known("show", name, &names, "tables and charts")?;
        }
        for exhibit in &self.exhibit {
            exhibit.check(&sweeps)?;
        }
        let empty = |key: &str| {
            let message = "is empty; give at least one entry";
            Err(Error::new(ErrorKind::Content, message).at_key(key))
        };
        match (&*self.views, &*self.measure) {
            ([], _) => empty("views"),
            (_, []) => empty("measure"),
            _ => Ok(()),
        }
    }

    /// Applies what the command line names.
    pub fn apply(&mut self, given: &Overrides) {
        fn put<T>(own: &mut T, other: Option<T>) {
            if let Some(other) = other {
                *own = other;
            }
        }
        let quick = self.quick.take().filter(|_| given.quick);
        let mut quick = quick.unwrap_or_default();
        if given.lists.combines() {
            quick.measure = self.combinations.take();
        }
        put(&mut self.time, quick.time);
        put(&mut self.views, quick.views);
        put(&mut self.measure, quick.measure);
        put(&mut self.flights, quick.flights);
        for views in &mut self.views {
            views.apply(given);
        }
        for measure in &mut self.measure {
            given.lists.replace(measure);
        }
        let exactly = |given: Option<usize>, own| given.map_or(own, |n| (n, n));
        self.time.passes = exactly(given.passes, self.time.passes);
        self.time.rounds = exactly(given.rounds, self.time.rounds);
        if let Some(seconds) = given.max_seconds {
            self.time.limit = Some(seconds);
            self.time.seconds = self.time.seconds.min(seconds);
        }
    }

    /// The measurements.
    pub fn plan(&self, given: &Overrides) -> Result<Plan> {
        let mut views = Vec::new();
        for group in &self.views {
            views.extend(group.views(&given.scenes)?);
        }
        let mut plan = Plan::new(views);
        plan.mixed = self.mixed;
        plan.pixel_errors = self.pixel_errors;
        plan.wall_clock = self.wall_clock;
        plan.truth_rays = self.truth_rays.max(1);
        for view in 0..plan.views.len() {
            for measure in &self.measure {
                plan.add_entry(view, measure, &given.methods);
            }
        }
        Ok(plan)
    }
}

fn known(key: &str, name: &str, all: &[&str], what: &str) -> Result<()> {
    if all.contains(&name) {
        return Ok(());
    }
    let all = all.join(", ");
    let message = format!("{name:?} is not among {what}; give one of {all}");
    Err(Error::new(ErrorKind::Content, message).at_key(key))
}

/// A fault of TOML or of a value, on one line: where, and what is allowed.
fn fault(text: &str, error: &toml::de::Error) -> Error {
    let start = error.span().map_or(0, |span| span.start.min(text.len()));
    let before = text.get(..start).unwrap_or("");
    let number = before.matches('\n').count() + 1;
    let line = text.lines().nth(number - 1).unwrap_or("");
    let place = match line.split('=').next().unwrap_or(line).trim() {
        "" => format!("line {number}"),
        key => format!("line {number}, {key}"),
    };
    Error::new(ErrorKind::Content, error.message()).at_key(place)
}

#[cfg(test)]
mod tests;
