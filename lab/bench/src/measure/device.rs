//! Measuring on a Vulkan device, against the double-precision reference.

use crate::measure::row::Sample;
use crate::measure::{Bench, TimedDraw};
use crate::plan::method::renderer::{MethodDevice, MethodRenderer};
use crate::plan::method::{Edges, MethodSettings};
use crate::plan::view::View;
use revmap::error::Result;
use revmap::frame::Frame;
use revmap::gpu::Device;
use revmap::scene::Scene;
use revmap_offscreen::samples::averaged;
use revmap_reference as reference;
use revmap_searches::folder::check_frame;
use std::time::Instant;

/// A Vulkan device to measure on.
pub struct DeviceBench {
    device: MethodDevice,
    /// True if the device's clock counts, where it has one.
    own_clock: bool,
}

impl DeviceBench {
    /// Measures on this device; without its own clock by the wall clock alone.
    pub fn new(device: Device, own_clock: bool) -> Result<Self> {
        let device = MethodDevice::new(device)?;
        Ok(Self { device, own_clock })
    }
}

/// A way to draw one frame.
enum Drawer {
    /// So many frames, one for each ray of a pixel.
    Rays(MethodRenderer, u32),
    /// A frame whose silhouettes are smoothed when it is read, and one without.
    Smoothed([MethodRenderer; 2]),
}

impl Drawer {
    /// Applies a scene; returns the milliseconds that it takes.
    fn change(&mut self, scene: &Scene) -> Result<f64> {
        let start = Instant::now();
        match self {
            Self::Rays(renderer, _) => renderer.update(scene)?,
            Self::Smoothed(both) => both.iter_mut().try_for_each(|r| r.update(scene))?,
        }
        Ok(start.elapsed().as_secs_f64() * 1e3)
    }

    /// Draws a frame and waits for it. `change_ms`: of the change before it.
    fn draw(&mut self, mut change_ms: Option<f64>) -> Result<Sample> {
        let (mut gpu_ms, mut frame_ms) = (Some(0.0), 0.0);
        match self {
            Self::Rays(renderer, count) => {
                // One stage per submission: timestamps around both in one are wrong on some
                // drivers.
                for _ in 0..*count {
                    let times = renderer.draw()?;
                    gpu_ms = gpu_ms.zip(times.gpu_ms).map(|(sum, ms)| sum + ms);
                    frame_ms += times.frame_ms;
                    change_ms = change_ms.map(|ms| ms + times.prepare_ms);
                }
            }
            Self::Smoothed([smoothed, plain]) => {
                // Reading takes the same for all but what smoothing adds, which is not negative.
                plain.draw()?;
                let usual = read_ms(plain)?;
                frame_ms = smoothed.draw()?.frame_ms;
                frame_ms += (read_ms(smoothed)? - usual).max(0.0);
                gpu_ms = None;
            }
        }
        Ok(Sample {
            gpu_ms,
            frame_ms,
            change_ms,
        })
    }
}

/// Milliseconds of reading a frame.
fn read_ms(renderer: &mut MethodRenderer) -> Result<f64> {
    let start = Instant::now();
    renderer.read()?;
    Ok(start.elapsed().as_secs_f64() * 1e3)
}

impl Bench for DeviceBench {
    fn timed(&mut self, view: &View, settings: &MethodSettings) -> Result<TimedDraw> {
        let scene = &view.scene;
        let mut drawer = match settings.edges {
            Edges::OneRay | Edges::Msaa => Drawer::Rays(self.device.renderer(scene, settings)?, 1),
            Edges::Rays(count) => Drawer::Rays(self.device.renderer(scene, settings)?, count),
            Edges::Silhouettes => {
                let plain = MethodSettings {
                    edges: Edges::OneRay,
                    ..*settings
                };
                let renderer = |settings| self.device.renderer(scene, settings);
                Drawer::Smoothed([renderer(settings)?, renderer(&plain)?])
            }
        };
        let own_clock = self.own_clock;
        let moving = view.offset_moves.then(|| view.clone());
        let (mut changed, mut frame) = (scene.clone(), 0);
        Ok(Box::new(move || {
            let change = |view: &View| {
                frame += 1;
                view.move_offset(&mut changed, frame);
                drawer.change(&changed)
            };
            let change_ms = moving.as_ref().map(change).transpose()?;
            let mut sample = drawer.draw(change_ms)?;
            sample.gpu_ms = sample.gpu_ms.filter(|_| own_clock);
            Ok(sample)
        }))
    }

    fn picture(&mut self, view: &View, settings: &MethodSettings) -> Result<(Frame, u64)> {
        let count = match settings.edges {
            Edges::Rays(count) => count,
            _ => 1,
        };
        let mut renderer = self.device.renderer(&view.scene, settings)?;
        let mut frame = averaged(count, &view.scene, |scene| {
            renderer.update(scene)?;
            renderer.draw()?;
            renderer.read()
        })?;
        if settings.edges == Edges::Msaa {
            // Means of distances and normals mean nothing.
            let (width, height) = (frame.width, frame.height);
            let empty = Frame::new(width, height, view.scene.background)?;
            frame = Frame {
                color: frame.color,
                ..empty
            };
        }
        let solver = settings.method.solver();
        solver.map_or(Ok(()), |s| check_frame(s, &frame))?;
        Ok((frame, renderer.map_bytes().iter().sum()))
    }

    fn truth(&mut self, view: &View, settings: &MethodSettings) -> Result<Frame> {
        reference::draw(&view.scene, &settings.into(), &|_, _| {})
    }
}
