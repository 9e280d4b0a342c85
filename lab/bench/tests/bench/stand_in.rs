//! A stand-in for the device of a benchmark, with a fault in it if one is wanted.

use glam::DVec3;
use revmap::error::{Error, ErrorKind, Result};
use revmap::frame::Frame;
use revmap::profile::Profile;
use revmap::scene::{Camera, Object, Scene};
use revmap::settings::{DrawStage, Solver};
use revmap_bench::measure::row::Sample;
use revmap_bench::measure::{Bench, Measured, Observer, TimedDraw, measure};
use revmap_bench::plan::method::{Method, MethodSettings};
use revmap_bench::plan::view::View;
use revmap_bench::plan::{Measure, Pick, Plan, TimeBudget, is_rbm_baseline};
use revmap_reference as reference;
use revmap_searches::CIRCLE;
use std::cell::RefCell;
use std::rc::Rc;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

/// What is wrong with the stand-in's drawing.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Fault {
    None,
    /// The search dawdles.
    Sleeps,
    /// The search takes the box for the solid.
    BoxFace,
    /// The device's clock reads a hundredth.
    ClockLies,
    /// While the first six frames are timed another program has the processor, and the wall clock
    /// shows three times the time.
    Disturbed,
    /// In its first group and pass the search takes twice its time.
    Bout,
    /// The search takes twice as long in each pass as in the one before.
    Grows,
    /// This way of drawing does not apply.
    Refuses,
    /// The device is gone.
    DeviceLost,
}

/// A device that draws the reference in a time that it makes up; `live` has the planted fault.
pub struct StandIn {
    fault: Fault,
    /// Every frame that was timed: the view and the search.
    pub frames: Rc<RefCell<Vec<Method>>>,
    /// How often something was made ready to be timed.
    pub made: usize,
    /// Every picture of which the truth was asked: the view and the width.
    pub truths: Vec<(String, u32)>,
    /// After so many frames, what is then set.
    pub stop_after: Option<(usize, &'static AtomicBool)>,
}

impl StandIn {
    pub fn new(fault: Fault) -> Self {
        Self {
            fault,
            frames: Rc::default(),
            made: 0,
            truths: Vec::new(),
            stop_after: None,
        }
    }

    fn refusal(&self, settings: &MethodSettings) -> Result<()> {
        match self.fault {
            Fault::Refuses if settings.method == Solver::Live => {
                let message = "this search does not apply to this profile";
                Err(Error::new(ErrorKind::Other, message))
            }
            Fault::DeviceLost => Err(Error::new(ErrorKind::DeviceLost, "the device is gone")),
            _ => Ok(()),
        }
    }
}

impl Bench for StandIn {
    fn timed(&mut self, _: &View, settings: &MethodSettings) -> Result<TimedDraw> {
        self.refusal(settings)?;
        self.made += 1;
        let live = settings.method == Solver::Live;
        let papers = is_rbm_baseline(settings);
        let base = if papers { 20.0 } else { 10.0 };
        let factor = match self.fault {
            Fault::Sleeps if live => 3.0,
            Fault::Bout if live && self.made <= 3 => 2.0,
            // Six are made in each pass.
            Fault::Grows if live => {
                std::thread::sleep(std::time::Duration::from_millis(5));
                2f64.powf((self.made / 6) as f64)
            }
            _ => 1.0,
        };
        let frame_ms = base * factor;
        let lies = live && self.fault == Fault::ClockLies;
        let gpu_ms = frame_ms * if lies { 0.01 } else { 0.98 };
        let (method, frames, stop_after) = (settings.method, self.frames.clone(), self.stop_after);
        let disturbed = live && self.fault == Fault::Disturbed;
        let steady = matches!(self.fault, Fault::Bout | Fault::Grows);
        Ok(Box::new(move || {
            let mut frames = frames.borrow_mut();
            frames.push(method);
            if let Some((count, stop)) = stop_after {
                stop.fetch_or(frames.len() >= count, Ordering::Relaxed);
            }
            // The machine gets slower and faster again, by a third, as machines do.
            let drift = match steady {
                true => 1.0,
                false => 1.0 + 0.3 * (frames.len() as f64 * 0.05).sin(),
            };
            let timed = frames.iter().filter(|m| **m == method).count() - 1;
            let other = disturbed && (1..=6).contains(&timed);
            Ok(Sample {
                gpu_ms: Some(gpu_ms * drift),
                frame_ms: frame_ms * drift * if other { 3.0 } else { 1.0 },
                change_ms: None,
            })
        }))
    }

    fn picture(&mut self, view: &View, settings: &MethodSettings) -> Result<(Frame, u64)> {
        self.refusal(settings)?;
        let mut view = view.clone();
        if settings.method == Solver::Live && self.fault == Fault::BoxFace {
            // A cylinder as wide and high as the box.
            let radius = view.scene.objects[0].profile.radius;
            let polygon = [[0.0, 0.0], [radius, 0.0], [radius, 1.0], [0.0, 1.0]];
            view.scene.objects[0].profile = Arc::new(Profile::polygon(&polygon, radius)?);
        }
        let mut frame = reference::draw(&view.scene, &settings.into(), &|_, _| {})?;
        // Nobody is perfect: a little error for all, or all would be on one front.
        let live = settings.method == Solver::Live;
        let error = if live { 1e-6 } else { 2e-6 };
        frame.distance.iter_mut().for_each(|d| *d += error);
        Ok((frame, 1000))
    }

    fn truth(&mut self, view: &View, settings: &MethodSettings) -> Result<Frame> {
        self.truths.push((view.name.clone(), settings.width));
        reference::draw(&view.scene, &settings.into(), &|_, _| {})
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

/// Two searches and the RBM baseline on both views, small.
pub fn plan() -> Plan {
    let methods = [Method::Search(Solver::Live), Method::Search(CIRCLE)].map(Pick::Method);
    let entry = Measure {
        stages: vec![DrawStage::Fragment],
        methods: methods.into_iter().chain([Pick::Baseline]).collect(),
        sizes: vec![(48, 36)],
        ..Measure::default()
    };
    let mut plan = Plan::new(views());
    for view in 0..plan.views.len() {
        plan.add_entry(view, &entry, &[]);
    }
    plan
}

/// Four passes of a few rounds, however long they take.
pub const LIMITS: TimeBudget = TimeBudget {
    seconds: 60.0,
    limit: None,
    passes: (4, 4),
    rounds: (3, 6),
    precision: 1e-9,
    warm_up: 1,
    resolved: 0.25,
};

/// Measures the plan within [`LIMITS`].
pub fn run(bench: &mut StandIn, stop: &AtomicBool) -> Result<Measured> {
    run_plan(&plan(), &LIMITS, bench, stop)
}

pub fn run_plan(
    plan: &Plan,
    limits: &TimeBudget,
    bench: &mut StandIn,
    stop: &AtomicBool,
) -> Result<Measured> {
    let mut observer = Observer {
        stop,
        progress: &|_, _, _| {},
        picture: &mut |_| Ok(()),
        passed: &mut |_| Ok(()),
    };
    measure(plan, bench, limits, &mut observer)
}

pub fn measured(fault: Fault) -> Measured {
    run(&mut StandIn::new(fault), &AtomicBool::new(false)).unwrap()
}
