//! Draws every case by every search in both stages and judges each picture.

use super::case::{Case, Step};
use super::glance::Spot;
use super::judge::{Faults, Judged, Truth};
use revmap::error::{ErrorKind, Result};
use revmap::frame::Frame;
use revmap::gpu::Device;
use revmap::scene::Scene;
use revmap::settings::{DrawStage, Settings, Solver};
use revmap_figures::files::write_text;
use revmap_figures::names::number;
use revmap_files::Picture;
use revmap_offscreen::Offscreen;
use revmap_searches::folder::{check_frame, check_scene, name_of};
use revmap_searches::watchdog::watched;
use std::collections::HashMap;
use std::path::Path;
use std::time::Instant;

/// Both stages; the second is compared with the first.
pub const STAGES: [DrawStage; 2] = [DrawStage::Fragment, DrawStage::Compute];

/// The start of a message about a scene whose map is larger than the library allows.
pub(super) const TOO_LARGE: &str = "its map is too large";

/// How a trial came out, from the best to the worst.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Verdict {
    /// Within the limits.
    Passed,
    /// Refused with an error, as some searches do.
    Refused,
    /// Within the limits, though the default is known to fail: the entry is out of date.
    Healed,
    /// Beyond them, as is known of the default.
    Known,
    /// Beyond them.
    Failed,
}

impl Verdict {
    /// As tables have it.
    pub fn name(self) -> &'static str {
        match self {
            Self::Passed => "passed",
            Self::Refused => "refused",
            Self::Healed => "healed",
            Self::Known => "known",
            Self::Failed => "failed",
        }
    }
}

/// One picture: a scene of a case, by a search, in a stage.
#[derive(Clone, Debug)]
pub struct Trial {
    /// Index of the case.
    pub case: usize,
    /// The parameter's value.
    pub value: f64,
    /// The search.
    pub solver: Solver,
    /// The stage.
    pub stage: DrawStage,
    /// What became of it; the message of an error where nothing was drawn.
    pub judged: std::result::Result<Judged, String>,
    /// Faults that it may have.
    pub limit: usize,
    /// Milliseconds of the first frame, pipelines included.
    pub ms: f64,
    /// The verdict.
    pub verdict: Verdict,
}

/// The failure of a case that is seen best.
pub struct Glance {
    /// Index of the case.
    pub case: usize,
    /// How much is seen, as [`Spot::seen`].
    seen: f64,
    /// What [`Spot::strip`] shows of it, and its caption.
    pub shot: (Picture, String),
}

/// All trials, and what is shown of each case.
#[derive(Default)]
pub struct Outcome {
    /// Every picture that was judged.
    pub trials: Vec<Trial>,
    /// One of each case.
    pub glances: Vec<Glance>,
}

/// What is drawn.
pub struct Plan<'a> {
    /// The cases.
    pub cases: &'a [Case],
    /// The searches.
    pub solvers: &'a [Solver],
    /// Whether the first and the last scene of each case are enough.
    pub quick: bool,
    /// Where scenes are written, and the files that they name.
    pub folder: &'a Path,
}

/// Runs the plan. `progress` is told which case, how many pictures are done and how many there are.
///
/// # Errors
/// Of the catalogue's scenes, of the reference, of files. Errors of drawing are part of the
/// outcome.
pub fn run(
    device: &Device,
    plan: &Plan,
    progress: &mut dyn FnMut(&str, usize, usize) -> bool,
) -> Result<Outcome> {
    super::cases::write_files(plan.folder)?;
    let chosen = |case: &Case| match case.values[..] {
        [first, .., last] if plan.quick => vec![first, last],
        _ => case.values.clone(),
    };
    let total: usize = plan.cases.iter().map(|c| chosen(c).len()).sum();
    let mut done = 0;
    let mut outcome = Outcome::default();
    for (number, case) in plan.cases.iter().enumerate() {
        let mut shown: Option<Glance> = None;
        // The faults of each search and stage in the frame before, of motions.
        let mut before: HashMap<(Solver, DrawStage), Faults> = HashMap::new();
        for value in chosen(case) {
            if !progress(&case.name, done, total) {
                return Ok(outcome);
            }
            done += 1;
            let step = super::cases::step(case, value)?;
            let file = format!("{}-{value}.toml", case.name);
            write_text(&plan.folder.join(file), &step.scene)?;
            let scene = step.read(plan.folder)?;
            let truth = Truth::new(&scene, &step)?;
            let reference = Picture::of(&truth.frame)?;
            for &solver in plan.solvers {
                for mut one in both_stages(device, &step, &scene, &truth, solver)? {
                    if let (true, Ok((_, faults, judged))) = (case.motion, &mut one.result) {
                        let last = before.insert((solver, one.stage), faults.clone());
                        judged.flicker = last.map(|last| last.flicker(faults));
                    }
                    let judged = one.result.as_ref().map(|r| r.2.clone());
                    let judged = judged.map_err(|error| {
                        let of_map = error
                            .key
                            .as_ref()
                            .is_some_and(|key| key.ends_with("map_rows"));
                        match of_map || error.kind == ErrorKind::TooLarge {
                            true => format!("{TOO_LARGE} ({error})"),
                            false => error.to_string(),
                        }
                    });
                    let known = case.is_known(value);
                    outcome.trials.push(Trial {
                        case: number,
                        value,
                        solver,
                        stage: one.stage,
                        limit: truth.limit,
                        ms: one.ms,
                        verdict: verdict(&judged, truth.limit, solver, known),
                        judged,
                    });
                    if let Ok((frame, ..)) = one.result {
                        let picture = Picture::of(&frame)?;
                        let spot = Spot::worst(&picture, &reference);
                        if shown.as_ref().is_none_or(|shown| spot.seen > shown.seen) {
                            let strip = spot.strip(&picture, &reference, &truth.heat(&frame)?);
                            let nothing = [", nothing is seen", ""][usize::from(spot.seen > 0.0)];
                            let (stage, at) = (one.stage.name(), self::number(value, 6));
                            let caption = format!("{solver}, {stage}, at {at}{nothing}");
                            shown = Some(Glance {
                                case: number,
                                seen: spot.seen,
                                shot: (strip, caption),
                            });
                        }
                    }
                }
            }
        }
        outcome.glances.extend(shown);
    }
    Ok(outcome)
}

/// A picture as one stage draws it.
pub(super) struct Attempt {
    pub stage: DrawStage,
    /// Milliseconds.
    ms: f64,
    /// The frame, its faults, and what became of it.
    pub result: Result<(Frame, Faults, Judged)>,
}

/// A scene by a search in both stages, each judged; the second is compared with the first.
pub(super) fn both_stages(
    device: &Device,
    step: &Step,
    scene: &Scene,
    truth: &Truth,
    solver: Solver,
) -> Result<Vec<Attempt>> {
    let mut all: Vec<Attempt> = Vec::new();
    for stage in STAGES {
        let begun = Instant::now();
        let frame = draw(device, step, scene, solver, stage);
        let ms = begun.elapsed().as_secs_f64() * 1e3;
        let other = all.iter().find_map(|one| one.result.as_ref().ok());
        let result = match frame {
            Ok(frame) => {
                let (judged, faults) = truth.judge(&frame, other.map(|(frame, ..)| frame))?;
                Ok((frame, faults, judged))
            }
            Err(error) => Err(error),
        };
        all.push(Attempt { stage, ms, result });
    }
    Ok(all)
}

/// One picture, as the catalogue draws it.
fn draw(
    device: &Device,
    step: &Step,
    scene: &Scene,
    solver: Solver,
    stage: DrawStage,
) -> Result<Frame> {
    let settings = Settings {
        stage,
        solver,
        ..step.settings
    };
    check_scene(solver, scene)?;
    let mut offscreen = Offscreen::new(device, scene, &settings)?;
    for _ in 0..step.frame {
        watched(name_of(solver), || offscreen.draw())?;
    }
    let frame = offscreen.read()?;
    check_frame(solver, &frame)?;
    drop(offscreen);
    device.check()?;
    Ok(frame)
}

fn verdict(
    judged: &std::result::Result<Judged, String>,
    limit: usize,
    solver: Solver,
    known: bool,
) -> Verdict {
    let is_default = solver == Solver::DEFAULT;
    let passed = judged.as_ref().is_ok_and(|judged| judged.passes(limit));
    match (passed, known && is_default) {
        (true, false) => Verdict::Passed,
        (true, true) => Verdict::Healed,
        (false, true) => Verdict::Known,
        (false, false) if judged.is_err() && !is_default => Verdict::Refused,
        (false, false) => Verdict::Failed,
    }
}
