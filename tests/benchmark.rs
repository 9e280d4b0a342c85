//! The benchmark itself on trial: planted faults that it must find, with a stand-in for the device.
#![cfg(feature = "report")]
#![allow(clippy::unwrap_used, clippy::panic)]

use glam::DVec3;
use revmap::error::{Error, Result, Stage};
use revmap::frame::Frame;
use revmap::profile::Profile;
use revmap::reference;
use revmap::report::chart::front::front;
use revmap::report::curves::{self, Measure};
use revmap::report::folder;
use revmap::report::machine::Machine;
use revmap::report::measure::{Bench, Limits, Measured, Sample, Subject, Watch, measure};
use revmap::report::overview;
use revmap::report::pictures::Album;
use revmap::report::plan::{Axes, Labels, Plan, is_papers_loop};
use revmap::report::ratios::over_papers_loop;
use revmap::report::row::{Clocks, Row};
use revmap::report::view::View;
use revmap::scene::{Camera, Object, Scene};
use revmap::settings::{DrawStage, Settings, Solver};
use std::cell::RefCell;
use std::rc::Rc;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Duration;

/// What is wrong with the stand-in's drawing.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Fault {
    None,
    /// The search dawdles.
    Sleeps,
    /// The search takes the box for the solid.
    BoxFace,
    /// The device's clock reads a hundredth.
    ClockLies,
    /// This way of drawing does not apply.
    Refuses,
    /// The device is gone.
    DeviceLost,
}

/// A device that draws the reference in a time that it makes up; `live` has the planted fault.
struct StandIn {
    fault: Fault,
    /// Every frame that was timed: the view and the search.
    frames: Rc<RefCell<Vec<Solver>>>,
    /// How often something was made ready to be timed.
    made: usize,
    /// Every picture of which the truth was asked: the view and the width.
    truths: Vec<(String, u32)>,
    stop_after: Option<(usize, &'static AtomicBool)>,
}

struct Timed {
    gpu_ms: f64,
    frame_ms: f64,
    solver: Solver,
    frames: Rc<RefCell<Vec<Solver>>>,
    stop_after: Option<(usize, &'static AtomicBool)>,
}

impl Subject for Timed {
    fn sample(&mut self) -> Result<Sample> {
        let mut frames = self.frames.borrow_mut();
        frames.push(self.solver);
        if let Some((count, stop)) = self.stop_after {
            stop.fetch_or(frames.len() >= count, Ordering::Relaxed);
        }
        // The machine gets slower and faster again, by a third, as machines do.
        let drift = 1.0 + 0.3 * (frames.len() as f64 * 0.05).sin();
        Ok(Sample {
            gpu_ms: Some(self.gpu_ms * drift),
            frame_ms: self.frame_ms * drift,
        })
    }
}

impl StandIn {
    fn new(fault: Fault) -> Self {
        Self {
            fault,
            frames: Rc::default(),
            made: 0,
            truths: Vec::new(),
            stop_after: None,
        }
    }

    fn refusal(&self, settings: &Settings) -> Result<()> {
        match self.fault {
            Fault::Refuses if settings.solver == Solver::Live => Err(Error::new(
                Stage::Draw,
                "this search does not apply to this profile",
            )),
            Fault::DeviceLost => Err(Error::new(Stage::Device, "the device is gone")),
            _ => Ok(()),
        }
    }
}

impl Bench for StandIn {
    fn subject(&mut self, _: &View, settings: &Settings) -> Result<Box<dyn Subject>> {
        self.refusal(settings)?;
        self.made += 1;
        let live = settings.solver == Solver::Live;
        let base = if is_papers_loop(settings) { 20.0 } else { 10.0 };
        let frame_ms = if live && self.fault == Fault::Sleeps {
            base * 3.0
        } else {
            base
        };
        let gpu_ms = if live && self.fault == Fault::ClockLies {
            frame_ms / 100.0
        } else {
            frame_ms * 0.98
        };
        Ok(Box::new(Timed {
            gpu_ms,
            frame_ms,
            solver: settings.solver,
            frames: self.frames.clone(),
            stop_after: self.stop_after,
        }))
    }

    fn picture(&mut self, view: &View, settings: &Settings) -> Result<(Frame, u64)> {
        self.refusal(settings)?;
        let mut view = view.clone();
        if settings.solver == Solver::Live && self.fault == Fault::BoxFace {
            // A cylinder as wide and high as the box.
            let radius = view.scene.objects[0].profile.radius;
            let polygon = [[0.0, 0.0], [radius, 0.0], [radius, 1.0], [0.0, 1.0]];
            view.scene.objects[0].profile = Arc::new(Profile::polygon(&polygon, radius)?);
        }
        let mut frame = reference::draw(&view.scene, settings, &|_, _| {})?;
        // Nobody is perfect: a little error for all, or all would be on one front.
        let error = if settings.solver == Solver::Live {
            1e-6
        } else {
            2e-6
        };
        frame.distance.iter_mut().for_each(|d| *d += error);
        Ok((frame, 1000))
    }

    fn truth(&mut self, view: &View, settings: &Settings) -> Result<Frame> {
        self.truths.push((view.name.clone(), settings.width));
        reference::draw(&view.scene, settings, &|_, _| {})
    }
}

fn views() -> Vec<View> {
    let double_cone = [[0.0, 0.0], [0.4, 0.5], [0.0, 1.0]];
    let scene = |eye: DVec3| {
        let mut scene = Scene::new(Camera::new(eye, DVec3::new(0.0, 0.0, 0.5)));
        let profile = Arc::new(Profile::polygon(&double_cone, 0.5).unwrap());
        scene.objects.push(Object::new("spindle", profile));
        scene
    };
    vec![
        View::new("side", scene(DVec3::new(2.0, 0.0, 0.5))),
        View::new("above", scene(DVec3::new(1.5, 0.0, 1.5))),
    ]
}

fn plan() -> Plan {
    let axes = Axes {
        stages: vec![DrawStage::Fragment],
        solvers: vec![Solver::Live, Solver::Circle],
        sizes: vec![(48, 36)],
        ..Axes::default()
    };
    let mut plan = Plan::new(views(), &axes.combinations());
    plan.add_papers_loop();
    plan
}

const LIMITS: Limits = Limits {
    time: Duration::from_secs(60),
    passes: (4, 4),
    rounds: (3, 6),
    precision: 1e-9,
    warm_up: 1,
};

fn run(bench: &mut StandIn, stop: &AtomicBool) -> Result<Measured> {
    let mut watch = Watch {
        stop,
        progress: &|_, _, _| {},
        picture: &mut |_| Ok(()),
        passed: &mut |_| Ok(()),
    };
    measure(&plan(), bench, &LIMITS, &mut watch)
}

fn measured(fault: Fault) -> Measured {
    run(&mut StandIn::new(fault), &AtomicBool::new(false)).unwrap()
}

fn of(rows: &[Row], solver: Solver) -> Vec<&Row> {
    rows.iter()
        .filter(|r| r.settings.solver == solver && !is_papers_loop(&r.settings))
        .collect()
}

/// Places of (time, error) on a chart and which of them are on the front, of the first view.
fn on_front(rows: &[Row]) -> Vec<Solver> {
    let first: Vec<&Row> = rows.iter().filter(|r| r.view == 0).collect();
    let points: Vec<_> = first
        .iter()
        .map(|r| {
            (
                r.time().map_or(f64::NAN, |t| t.value),
                Measure::Depth.of(r).unwrap_or(f64::NAN),
            )
        })
        .collect();
    front(&points, 1.0)
        .into_iter()
        .map(|i| first[i].settings.solver)
        .collect()
}

#[test]
fn without_a_fault_all_is_as_it_was_planted() {
    let outcome = measured(Fault::None);
    assert_eq!(
        (
            outcome.rows.len(),
            outcome.left_out.len(),
            outcome.interrupted
        ),
        (6, 0, false)
    );
    let ratios = over_papers_loop(&outcome.rows);
    let live = ratios
        .iter()
        .find(|r| r.settings.solver == Solver::Live)
        .unwrap();
    assert!(
        (live.time.value - 0.5).abs() < 0.03 && live.pictures == 2,
        "{live:?}"
    );
    assert!(live.wrong == 0.0 && live.depth_p99.unwrap() < 0.01);
    assert!(on_front(&outcome.rows).contains(&Solver::Live));
}

#[test]
fn a_search_that_sleeps_is_charted_slower() {
    let outcome = measured(Fault::Sleeps);
    let ratios = over_papers_loop(&outcome.rows);
    let live = ratios
        .iter()
        .find(|r| r.settings.solver == Solver::Live)
        .unwrap();
    assert!(
        (live.time.value - 1.5).abs() < 0.08 && live.time.low > 1.0,
        "{:?}",
        live.time
    );
    let (slept, other) = (
        of(&outcome.rows, Solver::Live),
        of(&outcome.rows, Solver::Circle),
    );
    for (slept, other) in slept.iter().zip(&other) {
        assert!(slept.time().unwrap().low > other.time().unwrap().high);
    }
    // In the chart its marker stands further right: marks in order of series, the markers of the plot before those of the legend.
    let rows: Vec<&Row> = outcome.rows.iter().filter(|r| r.view == 0).collect();
    let figure = curves::searches("t", &rows, Measure::Depth, &Settings::default());
    let lefts: Vec<f64> = figure
        .marks
        .iter()
        .filter(|m| matches!(m, revmap::report::chart::Mark::Shape { .. }))
        .map(|m| m.bounds()[0])
        .collect();
    assert!(lefts[0] > lefts[1] + 20.0, "{lefts:?}");
}

#[test]
fn a_search_that_returns_the_boxs_face_is_charted_wrong() {
    let outcome = measured(Fault::BoxFace);
    for row in of(&outcome.rows, Solver::Live) {
        assert!(row.errors.ghost > 100, "{:?}", row.errors);
        assert!(row.errors.depth.unwrap().p99 > 10.0 && row.errors.normal.unwrap().rms > 10.0);
        assert!(Measure::Wrong.of(row).unwrap() > 20.0);
    }
    assert_eq!(
        on_front(&outcome.rows),
        [Solver::Circle],
        "it must not stand on the front"
    );
    let ratio = &over_papers_loop(&outcome.rows)[0];
    assert!(ratio.wrong > 0.2 && ratio.depth_p99.unwrap() > 10.0);
}

#[test]
fn a_clock_that_lies_is_rejected() {
    let outcome = measured(Fault::ClockLies);
    for row in of(&outcome.rows, Solver::Live) {
        assert!(matches!(row.clocks(), Clocks::Disagree { .. }));
        assert_eq!(row.time(), None);
    }
    assert!(
        over_papers_loop(&outcome.rows)
            .iter()
            .all(|r| r.settings.solver != Solver::Live)
    );
    assert!(!on_front(&outcome.rows).contains(&Solver::Live));
    let marked = folder::left_out(&plan(), &outcome);
    assert_eq!(marked.records.len(), 2);
    assert!(
        marked.records[0][4].contains("more than 15 % apart"),
        "{:?}",
        marked.records[0]
    );
    // In results.csv the lie is not told.
    let results = folder::results(
        &outcome.rows,
        &Machine::here("stand-in", "none", "none", "revmap bench"),
    );
    let (solver, gpu, frame) = (
        results.column("solver").unwrap(),
        results.column("gpu_ms_median").unwrap(),
        results.column("frame_ms_median").unwrap(),
    );
    for record in &results.records {
        assert_eq!(record[gpu].is_empty(), record[solver] == "live");
        assert!(!record[frame].is_empty());
    }
}

#[test]
fn what_does_not_apply_is_left_out_with_its_reason() {
    let outcome = measured(Fault::Refuses);
    assert_eq!((outcome.rows.len(), outcome.left_out.len()), (4, 2));
    assert!(outcome.left_out[0].1.contains("does not apply"));
    let error = run(
        &mut StandIn::new(Fault::DeviceLost),
        &AtomicBool::new(false),
    )
    .unwrap_err();
    assert_eq!((error.stage, error.exit_code()), (Stage::Device, 3));
}

/// A B C, C B A: every search is drawn once a round, and nobody always follows the same neighbour; each pass makes all anew.
#[test]
fn samples_are_interleaved_and_passes_are_built_anew() {
    let mut bench = StandIn::new(Fault::None);
    let outcome = run(&mut bench, &AtomicBool::new(false)).unwrap();
    assert_eq!(bench.made, 6 * outcome.rows[0].passes.len());
    let frames = bench.frames.borrow();
    // One frame each to warm up, then the rounds of the first group.
    let rounds: Vec<&[Solver]> = frames[3..3 + 6 * 3].chunks(3).collect();
    for pair in rounds.windows(2) {
        let back: Vec<Solver> = pair[1].iter().rev().copied().collect();
        assert_eq!(pair[0], back.as_slice());
    }
    assert_ne!(rounds[0], rounds[1]);
}

/// The reference is slow: it draws each view at each size once, whatever the number of ways, passes and views that are measured in turn.
#[test]
fn no_truth_is_drawn_twice() {
    for mixed in [false, true] {
        let mut plan = plan();
        let sizes: Vec<_> = plan.cases.clone();
        for case in sizes {
            plan.add(
                case.view,
                Settings {
                    width: 32,
                    height: 24,
                    ..case.settings
                },
            );
        }
        plan.mixed = mixed;
        let mut bench = StandIn::new(Fault::None);
        let mut watch = Watch {
            stop: &AtomicBool::new(false),
            progress: &|_, _, _| {},
            picture: &mut |_| Ok(()),
            passed: &mut |_| Ok(()),
        };
        measure(&plan, &mut bench, &LIMITS, &mut watch).unwrap();
        let mut asked = bench.truths.clone();
        asked.sort();
        asked.dedup();
        assert_eq!((bench.truths.len(), asked.len()), (4, 4), "{mixed}");
    }
}

#[test]
fn an_interrupt_keeps_what_was_measured() {
    static STOP: AtomicBool = AtomicBool::new(false);
    let mut bench = StandIn::new(Fault::None);
    // In the second round of the first group.
    bench.stop_after = Some((7, &STOP));
    let outcome = run(&mut bench, &STOP).unwrap();
    assert!(
        outcome.interrupted && outcome.rows.len() == 3,
        "{}",
        outcome.rows.len()
    );
    assert!(outcome.rows.iter().all(|r| !r.frame_ms().is_empty()));
    // Before anything is done there is nothing to keep.
    let error = run(&mut StandIn::new(Fault::None), &AtomicBool::new(true)).unwrap_err();
    assert!(error.to_string().contains("stopped before"), "{error}");
}

/// All files of a run; every table parses, the page needs nothing from elsewhere, every row is in it.
#[test]
fn a_runs_folder_is_whole() {
    let folder = tempfile::tempdir().unwrap();
    let machine = Machine::here("stand-in", "none", "driver 1, with a comma", "revmap bench");
    let plan = plan();
    let mut album = Album::new(
        folder.path(),
        Labels::new(plan.cases.iter().map(|c| &c.settings)),
        |_| true,
    )
    .unwrap();
    let outcome = measure(
        &plan,
        &mut StandIn::new(Fault::ClockLies),
        &LIMITS,
        &mut Watch {
            stop: &AtomicBool::new(false),
            progress: &|_, _, _| {},
            picture: &mut |seen| album.add(seen),
            passed: &mut |rows| {
                assert_eq!(rows.len(), 6, "after each pass every row is there");
                folder::write_rows(folder.path(), rows, &machine)
            },
        },
    )
    .unwrap();
    folder::write(folder.path(), &plan, &outcome, &machine).unwrap();
    overview::write(folder.path(), &plan, &outcome, &machine, &album).unwrap();
    for (file, records) in [("results.csv", 6), ("left-out.csv", 2)] {
        let table = revmap::report::csv::Table::load(&folder.path().join(file)).unwrap();
        assert_eq!(table.records.len(), records, "{file}");
    }
    let raw = revmap::report::csv::Table::load(&folder.path().join("raw.csv")).unwrap();
    let samples: usize = outcome.rows.iter().map(|r| r.frame_ms().len()).sum();
    assert_eq!(raw.records.len(), samples);
    let page = std::fs::read_to_string(folder.path().join("report.html")).unwrap();
    for wanted in [
        "stand-in",
        "clocks disagree",
        "<svg",
        "data:image/png;base64,",
        "revmap bench",
    ] {
        assert!(page.contains(wanted), "{wanted}");
    }
    for foreign in ["<script", "src=\"http", "href=\"http", "@import"] {
        assert!(!page.contains(foreign), "{foreign}");
    }
    curves::write(folder.path(), &plan, &outcome, &machine, &album, &[]).unwrap();
    assert!(folder.path().join("side-48x36.html").exists());
    assert!(
        folder
            .path()
            .join("charts/summary-depth-error.png")
            .exists()
    );
}
