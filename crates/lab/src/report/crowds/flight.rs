//! A flight through the army: the time of every frame, and how far pictures are from exact ones.

use super::scenes;
use crate::compare::{PixelErrors, pixel_errors};
use crate::method::MethodSettings;
use crate::renderer::MethodDevice;
use crate::report::stats;
use crate::report::table::Table;
use revmap::error::Result;
use revmap::gpu::Times;
use revmap::settings::{Planes, Tolerance};
use std::time::Instant;

/// Frames before the first that counts: buffers grow, and drivers compile when they first draw.
const WARM: usize = 10;

/// A flight.
#[derive(Clone, Debug)]
pub struct Flight {
    /// How it was drawn.
    pub settings: MethodSettings,
    /// How many solids it went through.
    pub solids: u32,
    /// Of every frame; what the new view asks of the CPU is part of `prepare_ms`.
    pub times: Vec<Times>,
    /// Frames that were held to exact pictures, and their errors in pixels.
    pub errors: Vec<(usize, PixelErrors)>,
}

/// Flies through `count` solids in so many frames; each `every`th picture is held to an exact one.
///
/// # Errors
/// Of the device, and of the solids that the program carries.
pub fn fly(
    device: &MethodDevice,
    settings: &MethodSettings,
    count: u32,
    frames: usize,
    every: usize,
) -> Result<Flight> {
    let mut scene = scenes::army(count)?.scene;
    let at = |frame: usize| scenes::along(frame as f64 / frames as f64);
    let mut renderer = device.renderer(&scene, settings)?;
    renderer.prewarm()?;
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
            Ok::<_, revmap::Error>(device.draw(&scene, &all)?.frame)
        };
        let exact = picture(Tolerance::EXACT)?;
        errors.push((
            frame,
            pixel_errors(&scene, &exact, &picture(settings.tolerance)?)?,
        ));
    }
    Ok(Flight {
        settings: *settings,
        solids: count,
        times,
        errors,
    })
}

impl Flight {
    /// Milliseconds of a frame: preparing, recording and drawing it.
    fn whole(times: &Times) -> f64 {
        times.prepare_ms + times.frame_ms
    }

    /// Median and longest frame, milliseconds.
    #[must_use]
    pub fn frame_ms(&self) -> [f64; 2] {
        let all: Vec<f64> = self.times.iter().map(Self::whole).collect();
        let median = stats::median(&all).unwrap_or(f64::NAN);
        [median, all.into_iter().fold(0.0, f64::max)]
    }

    /// What the CPU takes of a median frame, milliseconds.
    #[must_use]
    pub fn prepare_ms(&self) -> f64 {
        let all: Vec<f64> = self.times.iter().map(|t| t.prepare_ms).collect();
        stats::median(&all).unwrap_or(f64::NAN)
    }

    /// The largest error over the pictures that were compared, pixels: of 99.9 % of the pixels,
    /// and of contours.
    #[must_use]
    pub fn worst(&self) -> [f64; 2] {
        let most =
            |of: fn(&PixelErrors) -> f64| self.errors.iter().map(|e| of(&e.1)).fold(0.0, f64::max);
        [most(|e| e.p999), most(|e| e.contour_max)]
    }

    /// Every frame.
    #[must_use]
    pub fn table(&self) -> Table {
        let header = [
            "frame",
            "prepare_ms",
            "gpu_ms",
            "frame_ms",
            "error_p999_px",
            "contour_max_px",
        ];
        let record = |(number, times): (usize, &Times)| {
            let errors = self.errors.iter().find(|e| e.0 == number).map(|e| &e.1);
            let error = |of: fn(&PixelErrors) -> f64| {
                errors.map(|e| format!("{:.4}", of(e))).unwrap_or_default()
            };
            vec![
                number.to_string(),
                format!("{:.3}", times.prepare_ms),
                times
                    .gpu_ms
                    .map(|ms| format!("{ms:.3}"))
                    .unwrap_or_default(),
                format!("{:.3}", times.frame_ms),
                error(|e| e.p999),
                error(|e| e.contour_max),
            ]
        };
        Table::new(header, self.times.iter().enumerate().map(record).collect())
    }
}
