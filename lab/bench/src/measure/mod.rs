//! Measuring a plan: accuracy once, time in passes and rounds.
//!
//! Measurements of one picture are taken in turn, A B A B, so that a machine that slows down slows
//! all of them. All groups are gone through several times (*passes*), each time with everything
//! built anew: what one placement in memory does to a time shows as spread between passes (see
//! `stats`). A pass in which another program disturbs a clock is taken again.

mod bench;
pub mod device;
mod drawer;
pub mod drawn;
pub(crate) mod growth;
pub mod machine;
pub mod ratios;
pub mod row;
pub(crate) mod surroundings;

pub use bench::{Bench, Observer, RenderedCase, TimedDraw};
pub use drawer::TRIES;

use crate::plan::method::{Edges, Method, MethodSettings};
use crate::plan::{Case, Plan, TimeBudget};
use drawer::Drawer;
use revmap::error::{Error, ErrorKind, Result};
use revmap::frame::Frame;
use revmap::settings::Planes;
use revmap_compare::{
    CompareOptions, Comparison, PIXELS_PER_DEGREE, PixelErrors, flip_map, mean_flip, pixel_errors,
};
use row::{Row, Steps};
use std::sync::atomic::Ordering;
use std::thread::ScopedJoinHandle;
use std::time::{Duration, Instant};

/// The outcome of a run.
#[derive(Clone, Debug)]
pub struct Measured {
    /// Rows in the order of the plan's cases, without those left out.
    pub rows: Vec<Row>,
    /// Cases that could not be measured, and why.
    pub left_out: Vec<(Case, String)>,
    /// True if the run was ended early.
    pub interrupted: bool,
    /// How long it took.
    pub took: Duration,
}

/// A frame and how far it is from the truth.
struct Compared {
    frame: Frame,
    errors: Result<Comparison>,
    pixels: Option<Result<PixelErrors>>,
    flip_own: Option<f64>,
}

/// Measures a plan.
///
/// # Errors
/// [`ErrorKind::Other`] when nothing could be measured (with the first reason);
/// [`ErrorKind::DeviceLost`]; those of the picture callback.
pub fn measure(
    plan: &Plan,
    bench: &mut dyn Bench,
    budget: &TimeBudget,
    observer: &mut Observer,
) -> Result<Measured> {
    let mut run = Run {
        plan,
        bench,
        budget,
        start: Instant::now(),
        rows: plan.cases.iter().map(|_| None).collect(),
        left_out: Vec::new(),
    };
    run.passes(observer)?;
    let interrupted = observer.stop.load(Ordering::Relaxed);
    let took = run.start.elapsed();
    let rows = run.timed();
    let left_out = run.left_out;
    if rows.is_empty() {
        let why = match left_out.first() {
            Some((_, why)) => why.clone(),
            None if interrupted => "stopped before the first measurement was done".into(),
            None => "the plan is empty; name a scene, a stage and a solver".into(),
        };
        let message = format!("nothing was measured: {why}");
        return Err(Error::new(ErrorKind::Other, message));
    }
    Ok(Measured {
        rows,
        left_out,
        interrupted,
        took,
    })
}

struct Run<'a> {
    plan: &'a Plan,
    bench: &'a mut dyn Bench,
    budget: &'a TimeBudget,
    start: Instant,
    rows: Vec<Option<Row>>,
    left_out: Vec<(Case, String)>,
}

impl Run<'_> {
    /// The plan's passes, then more over groups that are not resolved, until the limit.
    fn passes(&mut self, observer: &mut Observer) -> Result<()> {
        let (plan, budget) = (self.plan, self.budget);
        let groups = plan.groups();
        let mut visits = groups.len() * budget.passes.0;
        let (mut pass, mut planned) = (0, true);
        loop {
            let began = Instant::now();
            for group in &groups {
                if observer.stop.load(Ordering::Relaxed) {
                    return Ok(());
                }
                if !planned && self.resolved(group) {
                    continue;
                }
                let begin = Instant::now();
                let left = budget.time().saturating_sub(self.start.elapsed());
                let share = left / u32::try_from(visits.max(1)).unwrap_or(u32::MAX);
                if pass == 0 {
                    for picture in plan.pictures(group) {
                        self.accuracy(&picture, observer)?;
                    }
                }
                self.time(group, pass, begin + share, observer)?;
                visits = visits.saturating_sub(1);
            }
            pass += 1;
            (observer.passed)(&self.timed())?;
            planned = planned
                && pass < budget.passes.1
                && (pass < budget.passes.0 || !(self.known() || self.late(pass)));
            let done = budget.is_fixed() || groups.iter().all(|group| self.resolved(group));
            if budget.would_overrun(pass, self.start.elapsed(), began.elapsed())
                || (!planned && done)
            {
                return Ok(());
            }
            visits = visits.max(groups.len() * budget.passes.0.saturating_sub(pass).max(1));
        }
    }

    /// True if every time of a group that can be trusted is resolved.
    fn resolved(&self, group: &[usize]) -> bool {
        let times = group.iter().filter_map(|&index| self.rows[index].as_ref());
        let mut times = times.filter_map(Row::time);
        times.all(|time| time.relative() <= self.budget.resolved)
    }

    fn tell(&self, observer: &Observer, what: &str) {
        let gone = self.start.elapsed();
        let all = self.budget.time().max(gone);
        (observer.progress)(what, gone.as_millis() as u64, all.as_millis() as u64);
    }

    /// Leaves a case out for good; a lost device ends the run.
    fn leave_out(&mut self, index: usize, error: Error) -> Result<()> {
        if error.kind == ErrorKind::DeviceLost {
            return Err(error);
        }
        self.rows[index] = None;
        let case = self.plan.cases[index];
        self.left_out.push((case, error.to_string()));
        Ok(())
    }

    /// The rows of which there are times.
    fn timed(&self) -> Vec<Row> {
        let timed = |row: &&Row| row.passes.iter().any(|pass| !pass.is_empty());
        self.rows.iter().flatten().filter(timed).cloned().collect()
    }

    /// The picture that others are compared with; `of`: another method's than the default's.
    fn truth(&mut self, case: Case, of: Option<Method>) -> Result<Frame> {
        let view = &self.plan.views[case.view];
        if self.plan.truth_rays == 1 {
            return self.bench.truth(view, &case.settings);
        }
        let settings = MethodSettings {
            method: of.unwrap_or(Method::DEFAULT),
            edges: Edges::Rays(self.plan.truth_rays),
            planes: Planes::All,
            ..case.settings
        };
        Ok(self.bench.picture(view, &settings)?.0)
    }

    /// Draws each case that shows one picture once with all planes and compares it with the truth.
    fn accuracy(&mut self, group: &[usize], observer: &mut Observer) -> Result<()> {
        let Some(&first) = group.first() else {
            return Ok(());
        };
        let (plan, first) = (self.plan, self.plan.cases[first]);
        let view = &plan.views[first.view];
        self.tell(observer, &format!("{}: the reference", view.name));
        let truth = self.truth(first, None)?;
        let rays = plan.truth_rays > 1;
        let options = CompareOptions::of(view.texel());
        let mut reference = revmap_compare::Reference::new(&truth, &options)?;
        if !rays {
            reference = reference.of_scene(&view.scene)?;
        }
        let mut own: Option<(Method, Frame)> = None;
        // While a frame is compared the next is made ready: drivers compile on one thread.
        std::thread::scope(|scope| {
            let mut compared: Option<(usize, u64, ScopedJoinHandle<Compared>)> = None;
            for &index in group {
                if observer.stop.load(Ordering::Relaxed) {
                    break;
                }
                let case = plan.cases[index];
                let method = case.settings.method;
                self.tell(observer, &format!("{}: errors of {method}", view.name));
                let settings = case.settings.storing(Planes::All);
                let drawn = self.bench.picture(view, &settings);
                if let Some(one) = compared.take() {
                    self.keep(one, (&truth, &options), observer)?;
                }
                if rays && method != Method::DEFAULT && own.as_ref().is_none_or(|o| o.0 != method) {
                    own = Some((method, self.truth(case, Some(method))?));
                }
                match drawn {
                    Ok((frame, map_bytes)) => {
                        let reference = &reference;
                        let pixels = plan.pixel_errors && method != Method::Floor;
                        let own = own.as_ref().filter(|o| o.0 == method).map(|o| &o.1);
                        let flip_own =
                            own.map(|own| mean_flip(&flip_map(own, &frame, PIXELS_PER_DEGREE)));
                        let truth = &truth;
                        let work = scope.spawn(move || Compared {
                            errors: reference.compare(&frame),
                            pixels: pixels.then(|| pixel_errors(&view.scene, truth, &frame)),
                            flip_own,
                            frame,
                        });
                        compared = Some((index, map_bytes, work));
                    }
                    Err(error) => self.leave_out(index, error)?,
                }
            }
            match compared.take() {
                Some(one) => self.keep(one, (&truth, &options), observer),
                None => Ok(()),
            }
        })
    }

    /// Makes the row of a frame that was compared.
    fn keep(
        &mut self,
        (index, map_bytes, work): (usize, u64, ScopedJoinHandle<Compared>),
        (truth, options): (&Frame, &CompareOptions),
        observer: &mut Observer,
    ) -> Result<()> {
        let given_up = "a comparison was given up; report this";
        let compared = work
            .join()
            .map_err(|_| Error::new(ErrorKind::Other, given_up))?;
        let (frame, errors) = (&compared.frame, compared.errors?);
        let case = &self.plan.cases[index];
        (observer.picture)(&RenderedCase {
            plan: self.plan,
            case,
            frame,
            truth,
            options,
        })?;
        let view = &self.plan.views[case.view];
        let mut row = Row::new(view, case, errors, Steps::of(frame), map_bytes);
        row.pixel_errors = compared.pixels.transpose()?;
        row.flip_own = compared.flip_own;
        self.rows[index] = Some(row);
        Ok(())
    }

    /// Times the cases of a group in one pass, up to [`TRIES`] times while clocks disagree.
    fn time(
        &mut self,
        group: &[usize],
        pass: usize,
        end: Instant,
        observer: &Observer,
    ) -> Result<()> {
        let mut drawers = Vec::new();
        for &index in group {
            if self.rows[index].is_none() || observer.stop.load(Ordering::Relaxed) {
                continue;
            }
            let case = &self.plan.cases[index];
            let view = &self.plan.views[case.view];
            self.tell(observer, &format!("{}: pass {}", view.name, pass + 1));
            let made = self.bench.timed(view, &case.settings);
            let ready = made.and_then(|mut draw| {
                for _ in 0..self.budget.warm_up {
                    draw()?;
                }
                Ok(draw)
            });
            match ready {
                Ok(draw) => drawers.push(Drawer::new(index, draw)),
                Err(error) => self.leave_out(index, error)?,
            }
        }
        let mut tries = 1;
        loop {
            self.rounds(&mut drawers, pass, end, observer)?;
            let stop = observer.stop.load(Ordering::Relaxed);
            if stop || tries == TRIES || !drawers.iter().any(Drawer::is_disturbed) {
                break;
            }
            tries += 1;
            drawers.iter_mut().for_each(Drawer::begin_again);
        }
        for drawer in drawers {
            if let Some(row) = &mut self.rows[drawer.index] {
                row.passes.push(drawer.last_try());
            }
        }
        Ok(())
    }

    /// Draws a frame of each in turn until `end`, at least for the least number of rounds.
    fn rounds(
        &mut self,
        drawers: &mut Vec<Drawer>,
        pass: usize,
        end: Instant,
        observer: &Observer,
    ) -> Result<()> {
        let precision = self.budget.precision;
        for round in 0..self.budget.rounds.1 {
            let stop = observer.stop.load(Ordering::Relaxed);
            let done = || Instant::now() >= end || drawers.iter().all(|d| d.is_settled(precision));
            if stop || (round >= self.budget.rounds.0 && done()) {
                break;
            }
            let count = drawers.len();
            let mut failed = Vec::new();
            for turn in 0..count {
                // There and back, so that nobody always follows the same neighbour.
                let there = round % 2 == 0;
                let place = if there { turn } else { count - 1 - turn };
                if let Err(error) = drawers[place].draw() {
                    failed.push((place, error));
                }
            }
            failed.sort_by_key(|(place, _)| *place);
            for (place, error) in failed.into_iter().rev() {
                let drawer = drawers.remove(place);
                self.leave_out(drawer.index, error)?;
            }
            self.tell(observer, &format!("pass {}, round {}", pass + 1, round + 1));
        }
        Ok(())
    }

    /// True if every row's interval is narrow enough.
    fn known(&self) -> bool {
        let mut rows = self.rows.iter().flatten();
        rows.all(|row| row.resolved(self.budget.precision))
    }

    /// True if one more pass, as long as those before, would end too late.
    fn late(&self, passes: usize) -> bool {
        let gone = self.start.elapsed();
        gone + gone / u32::try_from(passes.max(1)).unwrap_or(1) > self.budget.time()
    }
}
