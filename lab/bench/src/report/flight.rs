//! A flight through the army, or an army that moves: the time of every frame, and how far pictures
//! are from exact ones.

use crate::measure::row::Row;
use crate::plan::method::renderer::MethodDevice;
use crate::plan::method::{Edges, Method, MethodSettings};
use crate::plan::{army, flight_camera};
use crate::report::columns::Cell;
use crate::report::plan_file::Flight;
use revmap::error::Result;
use revmap::scene::{Placement, Scene};
use revmap::settings::{DrawStage, Planes, Tolerance};
use revmap_compare::{PixelErrors, pixel_errors};
use revmap_figures::stats;
use revmap_figures::table::Table;
use revmap_offscreen::Times;
use std::time::Instant;

/// Frames before the first that counts: buffers grow, and drivers compile when they first draw.
const WARM: usize = 10;

/// The default search with a tolerance, as crowds are drawn.
pub fn settings(stage: DrawStage) -> MethodSettings {
    let mut settings = MethodSettings::default().in_stage(stage).sized(1366, 706);
    settings.tolerance = Tolerance::DEFAULT;
    settings.storing(Planes::Color)
}

/// A flight.
#[derive(Clone, Debug)]
pub struct FlightTimes {
    /// How it was drawn.
    pub settings: MethodSettings,
    /// What was flown.
    pub plan: Flight,
    /// Times of every frame; the CPU's part of a new view is within `prepare_ms`.
    pub times: Vec<Times>,
    /// Frames that were held to exact pictures, and their errors in pixels.
    pub errors: Vec<(usize, PixelErrors)>,
}

/// Flies through an army.
pub fn fly(device: &MethodDevice, settings: &MethodSettings, plan: &Flight) -> Result<FlightTimes> {
    let still = army(plan.copies)?.scene;
    let mut scene = still.clone();
    let at = |scene: &mut Scene, frame: usize| match plan.copies_move {
        true => shift_copies(scene, &still, frame),
        false => scene.camera = flight_camera(frame as f64 / plan.frames as f64),
    };
    let mut renderer = device.renderer(&scene, settings)?;
    renderer.offscreen.prewarm()?;
    for _ in 0..WARM {
        renderer.draw()?;
    }
    let mut times = Vec::with_capacity(plan.frames);
    for frame in 0..plan.frames {
        at(&mut scene, frame);
        let start = Instant::now();
        renderer.update(&scene)?;
        let update_ms = start.elapsed().as_secs_f64() * 1e3;
        let mut drawn = renderer.draw()?;
        drawn.prepare_ms += update_ms;
        times.push(drawn);
    }
    drop(renderer);
    let mut errors = Vec::new();
    for frame in (0..plan.frames).step_by(plan.compared) {
        at(&mut scene, frame);
        let picture = |tolerance| {
            let all = MethodSettings {
                tolerance,
                planes: Planes::All,
                ..*settings
            };
            device.draw(&scene, &all)
        };
        let exact = picture(Tolerance::EXACT)?;
        errors.push((
            frame,
            pixel_errors(&scene, &exact, &picture(settings.tolerance)?)?,
        ));
    }
    Ok(FlightTimes {
        settings: *settings,
        plan: plan.clone(),
        times,
        errors,
    })
}

/// Moves all copies up and down, each by a tenth of its height and at a time of its own.
fn shift_copies(scene: &mut Scene, still: &Scene, frame: usize) {
    for (object, still) in scene.objects.iter_mut().zip(&still.objects) {
        let moved = |(k, copy): (usize, &Placement)| {
            let mut copy = *copy;
            copy.position.z += 0.1 * (0.3 * frame as f64 + k as f64).sin();
            copy
        };
        object.instances = still.instances.iter().enumerate().map(moved).collect();
    }
}

impl FlightTimes {
    /// Median and longest frame, milliseconds: preparing, recording and drawing it.
    pub fn frame_ms(&self) -> [f64; 2] {
        let all = self.times.iter().map(|t| t.prepare_ms + t.frame_ms);
        let all: Vec<f64> = all.collect();
        let median = stats::median(&all).unwrap_or(f64::NAN);
        [median, all.into_iter().fold(0.0, f64::max)]
    }

    /// The CPU's part of a median frame, milliseconds.
    pub fn prepare_ms(&self) -> f64 {
        let all: Vec<f64> = self.times.iter().map(|t| t.prepare_ms).collect();
        stats::median(&all).unwrap_or(f64::NAN)
    }

    /// The largest error over the pictures, pixels: of 99.9 % of the pixels, and of contours.
    pub fn worst(&self) -> [f64; 2] {
        let most =
            |of: fn(&PixelErrors) -> f64| self.errors.iter().map(|e| of(&e.1)).fold(0.0, f64::max);
        [most(|e| e.p999), most(|e| e.contour_max)]
    }

    /// The median frame over the measured time of one solid in the same stage, over the ratio of the
    /// pixels hit.
    pub fn by_equal_pixels(&self, rows: &[&Row]) -> Option<f64> {
        let like = |row: &&&Row| {
            let (own, of) = (&self.settings, &row.settings);
            let drawn = |s: &MethodSettings| (s.method, s.edges, s.stage, s.tolerance, s.width);
            let one = (
                Method::DEFAULT,
                Edges::OneRay,
                own.stage,
                own.tolerance,
                own.width,
            );
            row.view == 0 && drawn(of) == one
        };
        let one = rows.iter().find(like)?;
        let hits: Vec<f64> = self.errors.iter().map(|e| e.1.pixels as f64).collect();
        let hits = stats::median(&hits)?;
        Some(self.frame_ms()[0] / one.time()?.value * one.errors.hits as f64 / hits)
    }

    /// A name for its file.
    pub fn name(&self) -> String {
        let moving = ["", "-copies-move"][usize::from(self.plan.copies_move)];
        let stage = self.settings.stage.name();
        format!("flight-{}-{stage}{moving}", self.plan.copies)
    }

    /// Every frame.
    pub fn table(&self) -> Table {
        let text = |n: Option<f64>| Cell::number(n).csv();
        let errors = |number: usize| self.errors.iter().find(|e| e.0 == number).map(|e| &e.1);
        Table::of(
            &self.times.iter().enumerate().collect::<Vec<_>>(),
            &[
                ("frame", &|(number, _)| number.to_string()),
                ("prepare_ms", &|(_, times)| text(Some(times.prepare_ms))),
                ("gpu_ms", &|(_, times)| text(times.gpu_ms)),
                ("frame_ms", &|(_, times)| text(Some(times.frame_ms))),
                ("error_p999_px", &|(number, _)| {
                    text(errors(*number).map(|e| e.p999))
                }),
                ("contour_max_px", &|(number, _)| {
                    text(errors(*number).map(|e| e.contour_max))
                }),
            ],
        )
    }
}

/// The table of flights. `rows`: what was measured with a camera that stands still.
pub fn table(flights: &[FlightTimes], rows: &[&Row]) -> Table {
    let text = |n: f64| Cell::Number(n).shown();
    Table::of(
        flights,
        &[
            ("solids", &|f| f.plan.copies.to_string()),
            ("stage", &|f| f.settings.stage.name().to_owned()),
            ("moves", &|f| {
                ["camera", "copies"][usize::from(f.plan.copies_move)].to_owned()
            }),
            ("frames", &|f| text(f.times.len() as f64)),
            ("median (ms)", &|f| text(f.frame_ms()[0])),
            ("of it CPU (ms)", &|f| text(f.prepare_ms())),
            ("by equal pixels", &|f| {
                Cell::number(f.by_equal_pixels(rows)).shown()
            }),
            ("slowest (ms)", &|f| text(f.frame_ms()[1])),
            ("slowest / median", &|f| {
                text(f.frame_ms()[1] / f.frame_ms()[0])
            }),
            ("pictures compared", &|f| text(f.errors.len() as f64)),
            ("error p99.9 (pixels)", &|f| text(f.worst()[0])),
            ("farthest contour (pixels)", &|f| text(f.worst()[1])),
        ],
    )
}
