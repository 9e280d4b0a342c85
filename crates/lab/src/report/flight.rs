//! A flight through the army: the time of every frame, and how far pictures are from exact ones.

use super::columns::Cell;
use super::plan::{army, flight_camera};
use super::stats;
use super::table::Table;
use crate::compare::{PixelErrors, pixel_errors};
use crate::method::MethodSettings;
use crate::renderer::MethodDevice;
use revmap::error::Result;
use revmap::gpu::Times;
use revmap::settings::{DrawStage, Planes, Tolerance};
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
    /// How many solids it went through.
    pub solids: u32,
    /// Times of every frame; the CPU's part of a new view is within `prepare_ms`.
    pub times: Vec<Times>,
    /// Frames that were held to exact pictures, and their errors in pixels.
    pub errors: Vec<(usize, PixelErrors)>,
}

/// Flies through `count` solids in so many frames; each `every`th picture is held to an exact one.
pub fn fly(
    device: &MethodDevice,
    settings: &MethodSettings,
    count: u32,
    frames: usize,
    every: usize,
) -> Result<FlightTimes> {
    let mut scene = army(count)?.scene;
    let at = |frame: usize| flight_camera(frame as f64 / frames as f64);
    let mut renderer = device.renderer(&scene, settings)?;
    renderer.offscreen.prewarm()?;
    for _ in 0..WARM {
        renderer.draw()?;
    }
    let mut times = Vec::with_capacity(frames);
    for frame in 0..frames {
        scene.camera = at(frame);
        let start = Instant::now();
        renderer.update(&scene)?;
        let update_ms = start.elapsed().as_secs_f64() * 1e3;
        let mut drawn = renderer.draw()?;
        drawn.prepare_ms += update_ms;
        times.push(drawn);
    }
    drop(renderer);
    let mut errors = Vec::new();
    for frame in (0..frames).step_by(every) {
        scene.camera = at(frame);
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
        solids: count,
        times,
        errors,
    })
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

/// The table of flights.
pub fn table(flights: &[FlightTimes]) -> Table {
    let text = |n: f64| Cell::Number(n).shown();
    Table::of(
        flights,
        &[
            ("solids", &|f| f.solids.to_string()),
            ("stage", &|f| f.settings.stage.name().to_owned()),
            ("frames", &|f| text(f.times.len() as f64)),
            ("median (ms)", &|f| text(f.frame_ms()[0])),
            ("of it CPU (ms)", &|f| text(f.prepare_ms())),
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
