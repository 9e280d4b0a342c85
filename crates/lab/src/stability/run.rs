//! Draws every case by every search in both stages and judges each picture.

use super::case::{Case, Step};
use super::glance::Spot;
use super::judge::{Faults, Judged, Limits, Truth};
use crate::compare::{CompareOptions, Heat, heat_map};
use crate::report::folder::write_text;
use revmap::error::Result;
use revmap::frame::Frame;
use revmap::gpu::{Device, Offscreen};
use revmap::settings::{DrawStage, Settings, Solver};
use revmap_files::Picture;
use std::collections::HashMap;
use std::path::Path;
use std::time::Instant;

/// Both stages; the second is compared with the first.
pub const STAGES: [DrawStage; 2] = [DrawStage::Fragment, DrawStage::Compute];

/// How a trial came out.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Verdict {
    /// Within the limits.
    Passed,
    /// Beyond them.
    Failed,
    /// Beyond them, as is known of the default.
    Known,
    /// Within them, though the default is known to fail: the entry is out of date.
    Healed,
    /// Refused with an error, as some searches do.
    Refused,
}

impl Verdict {
    /// As tables have it.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Passed => "passed",
            Self::Failed => "failed",
            Self::Known => "known",
            Self::Healed => "healed",
            Self::Refused => "refused",
        }
    }
}

/// One picture: a scene of a case, by a search, in a stage.
#[derive(Clone, Debug)]
pub struct Trial {
    /// Index of the case.
    pub case: usize,
    /// Index of its scene.
    pub step: usize,
    /// The search.
    pub solver: Solver,
    /// The stage.
    pub stage: DrawStage,
    /// What became of it; the message of an error where nothing was drawn.
    pub judged: std::result::Result<Judged, String>,
    /// What it may have.
    pub limits: Limits,
    /// Milliseconds of the first frame, pipelines included.
    pub ms: f64,
    /// The verdict.
    pub verdict: Verdict,
}

/// Pictures of a case's worst scene.
pub struct Sheet {
    /// Index of the case.
    pub case: usize,
    /// The parameter's value.
    pub value: f64,
    /// Drawn by the default, the reference, where the default is wrong.
    pub own: [Picture; 3],
    /// Which stage drew it.
    pub stage: DrawStage,
    /// The search that fails most, its picture and where that is wrong.
    pub other: Option<(Solver, [Picture; 2])>,
}

/// The failure of a case that is seen best.
pub struct Glance {
    /// Index of the case.
    pub case: usize,
    /// The parameter's value.
    pub value: f64,
    /// Which search drew it, in which stage.
    pub method: (Solver, DrawStage),
    /// How much of it is seen; 0: nothing.
    pub seen: u64,
    /// The picture: the whole, and a part of it as drawn, as the reference has it, and the
    /// difference.
    pub strip: Picture,
}

/// All trials and a sheet for each case.
#[derive(Default)]
pub struct Outcome {
    /// Every picture that was judged.
    pub trials: Vec<Trial>,
    /// Pictures for the report.
    pub sheets: Vec<Sheet>,
    /// Of each case the failure that is seen best.
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
    let chosen = |case: &Case| -> Vec<usize> {
        let count = case.steps.len();
        if plan.quick && count > 2 {
            vec![0, count - 1]
        } else {
            (0..count).collect()
        }
    };
    let total: usize = plan.cases.iter().map(|c| chosen(c).len()).sum();
    let mut done = 0;
    let mut outcome = Outcome::default();
    for (number, case) in plan.cases.iter().enumerate() {
        let mut worst: Option<(f64, Sheet)> = None;
        let mut seen: Option<Glance> = None;
        // The faults of each search and stage in the frame before, where frames are those of a
        // motion.
        let mut before: HashMap<(Solver, DrawStage), Faults> = HashMap::new();
        for index in chosen(case) {
            if !progress(case.name, done, total) {
                return Ok(outcome);
            }
            done += 1;
            let step = &case.steps[index];
            let file = format!("{}-{}.toml", case.name, step.value);
            write_text(&plan.folder.join(file), &step.scene)?;
            let scene = step.read(plan.folder)?;
            let truth = Truth::new(&scene, step.size)?;
            let mut drawn = Vec::new();
            for &solver in plan.solvers {
                let mut first: Option<Frame> = None;
                for stage in STAGES {
                    let begun = Instant::now();
                    let frame = draw(device, step, &scene, solver, stage);
                    let ms = begun.elapsed().as_secs_f64() * 1e3;
                    let limits = Limits::of((step.size.0 * step.size.1) as usize);
                    let judged = match &frame {
                        Ok(frame) => {
                            let (mut judged, faults) = truth.judge_pixels(frame, first.as_ref())?;
                            if case.motion {
                                let last = before.get(&(solver, stage));
                                judged.flicker = last.map(|last| last.flicker(&faults));
                                before.insert((solver, stage), faults);
                            }
                            Ok(judged)
                        }
                        Err(error) => Err(error.to_string()),
                    };
                    let known = case.known(stage, step.value);
                    let verdict = verdict(&judged, &limits, solver, known.is_some());
                    outcome.trials.push(Trial {
                        case: number,
                        step: index,
                        solver,
                        stage,
                        judged: judged.clone(),
                        limits,
                        ms,
                        verdict,
                    });
                    if let (Ok(frame), Ok(judged)) = (frame, judged) {
                        drawn.push((solver, stage, judged.share(), frame.clone()));
                        first.get_or_insert(frame);
                    }
                }
            }
            seen = glance(number, step.value, &truth, &drawn, seen)?;
            // The scene in which the default fares worst, else the one in which any does.
            let rank = |own: bool| {
                let of = drawn.iter().filter(|d| (d.0 == Solver::DEFAULT) == own);
                of.map(|d| d.2).fold(0.0, f64::max)
            };
            let score = 1e3 * rank(true) + rank(false).min(1.0);
            if worst.as_ref().is_none_or(|(s, _)| score > *s) {
                let sheet = sheet(number, step.value, &truth, &drawn)?;
                worst = sheet.map(|sheet| (score, sheet)).or(worst);
            }
        }
        outcome.sheets.extend(worst.map(|(_, sheet)| sheet));
        outcome.glances.extend(seen);
    }
    Ok(outcome)
}

/// One picture, as the catalogue draws it.
///
/// # Errors
/// Of drawing.
pub fn draw(
    device: &Device,
    step: &Step,
    scene: &revmap::scene::Scene,
    solver: Solver,
    stage: DrawStage,
) -> Result<Frame> {
    let settings = Settings {
        width: step.size.0,
        height: step.size.1,
        stage,
        solver,
        max_steps: step.max_steps,
        map_rows: step.map_rows,
        map_source: step.map_source,
        map_format: step.map_format,
        ..Settings::exact()
    };
    let mut offscreen = Offscreen::new(device, scene, &settings)?;
    for _ in 0..step.frame {
        offscreen.draw()?;
    }
    let frame = offscreen.read()?;
    drop(offscreen);
    device.check()?;
    Ok(frame)
}

fn verdict(
    judged: &std::result::Result<Judged, String>,
    limits: &Limits,
    solver: Solver,
    known: bool,
) -> Verdict {
    let known = known && solver == Solver::DEFAULT;
    match judged {
        Err(_) if solver == Solver::DEFAULT => {
            if known {
                Verdict::Known
            } else {
                Verdict::Failed
            }
        }
        Err(_) => Verdict::Refused,
        Ok(judged) => match (judged.passes(limits), known) {
            (true, false) => Verdict::Passed,
            (true, true) => Verdict::Healed,
            (false, true) => Verdict::Known,
            (false, false) => Verdict::Failed,
        },
    }
}

type Drawn = (Solver, DrawStage, f64, Frame);

/// Which of the pictures drawn shows the failure best, or the one `before`.
fn glance(
    case: usize,
    value: f64,
    truth: &Truth,
    drawn: &[Drawn],
    before: Option<Glance>,
) -> Result<Option<Glance>> {
    let reference = Picture::of(&truth.frame);
    let spots = drawn.iter().map(|(solver, stage, _, frame)| {
        let picture = Picture::of(frame);
        let spot = Spot::worst(&picture, &reference);
        (spot, picture, (*solver, *stage), frame)
    });
    let Some((spot, picture, method, frame)) = spots.max_by_key(|(spot, ..)| spot.seen) else {
        return Ok(before);
    };
    if before.as_ref().is_some_and(|b| b.seen >= spot.seen) {
        return Ok(before);
    }
    let options = CompareOptions {
        texel: truth.texel(),
        pixels_per_degree: None,
    };
    let heat = heat_map(&truth.frame, frame, &options, Heat::Depth)?;
    Ok(Some(Glance {
        case,
        value,
        method,
        seen: spot.seen,
        strip: spot.strip(&picture, &reference, &heat),
    }))
}

fn sheet(case: usize, value: f64, truth: &Truth, drawn: &[Drawn]) -> Result<Option<Sheet>> {
    let options = CompareOptions {
        texel: truth.texel(),
        pixels_per_degree: None,
    };
    let worst = |own: bool| {
        drawn
            .iter()
            .filter(|d| (d.0 == Solver::DEFAULT) == own)
            .max_by(|a, b| a.2.total_cmp(&b.2))
    };
    let heat = |frame: &Frame| heat_map(&truth.frame, frame, &options, Heat::Depth);
    let Some((_, stage, _, frame)) = worst(true).or_else(|| worst(false)) else {
        return Ok(None);
    };
    let other = match worst(false).filter(|d| d.2 > 0.0) {
        Some((solver, _, _, frame)) => Some((*solver, [Picture::of(frame), heat(frame)?])),
        None => None,
    };
    Ok(Some(Sheet {
        case,
        value,
        own: [Picture::of(frame), Picture::of(&truth.frame), heat(frame)?],
        stage: *stage,
        other,
    }))
}
