//! Conversion of a target's bytes to a frame.

use crate::antialias::{self, Solids};
use revmap::error::Result;
use revmap::frame::{Frame, linear_from_srgb};
use revmap::gpu::{ComputeTarget, View};
use revmap::scene::CameraFrame;
use revmap::settings::{Planes, Settings};

/// Makes a frame of `planes`, which [`Target::read`](crate::target::Target::read) returns.
pub(crate) fn frame(settings: &Settings, background: [f32; 4], planes: &[&[u8]]) -> Result<Frame> {
    let mut frame = Frame::new(settings.width, settings.height, background)?;
    match settings.planes {
        Planes::Color => {
            let linear = Linear::new();
            let bytes = planes.first().copied().unwrap_or_default();
            for (color, rgba) in frame.color.iter_mut().zip(bytes.as_chunks().0) {
                *color = linear.color(rgba);
            }
        }
        Planes::Depth { .. } | Planes::List(_) => {}
        Planes::All => {
            let [color, normal, shading, albedo, steps, ..] = planes else {
                return Ok(frame);
            };
            for (i, value) in frame.color.iter_mut().enumerate() {
                *value = vec4(color, i);
                let [x, y, z, distance] = vec4(normal, i);
                frame.normal[i] = [x, y, z];
                frame.distance[i] = distance;
                let [x, y, z, u] = vec4(shading, i);
                frame.shading_normal[i] = [x, y, z];
                let [r, g, b, v] = vec4(albedo, i);
                frame.albedo[i] = [r, g, b];
                frame.uv[i] = [u, v];
                let word: u32 = bytemuck::pod_read_unaligned(&steps[4 * i..4 * i + 4]);
                frame.exhausted += usize::from(word & ComputeTarget::EXHAUSTED != 0);
                let count = word & !ComputeTarget::EXHAUSTED;
                #[allow(clippy::cast_precision_loss)] // look-ups of a pixel stay far below 2^24
                {
                    frame.steps[i] = count as f32;
                }
            }
        }
    }
    Ok(frame)
}

/// Makes a frame with smoothed silhouettes. Uses depths if they are read beside colours.
pub(crate) fn smoothed(
    settings: &Settings,
    background: [f32; 4],
    planes: &[&[u8]],
    (solids, camera): (&Solids, &CameraFrame),
    view: &View,
) -> Result<Frame> {
    let [colors, depths] = planes else {
        let mut frame = frame(settings, background, planes)?;
        solids.smooth(camera, &mut frame);
        return Ok(frame);
    };
    let (colors, depths) = (colors.as_chunks().0, depths.as_chunks().0);
    let linear = Linear::new();
    let color = |pixel: usize| linear.color(&colors[pixel]);
    let depth = |pixel: usize| match f32::from_ne_bytes(depths[pixel]) {
        depth if depth < 1.0 => view.t_at(f64::from(depth)),
        _ => f64::INFINITY,
    };
    let size = (settings.width, settings.height);
    let mut changes = Vec::new();
    // The two tasks are independent. The frame is made on the thread that also frees it: memory
    // that goes from one thread to another is slow to take again.
    let mut frame = rayon::in_place_scope(|scope| {
        scope.spawn(|_| changes = solids.changes(camera, size, &depth, &color));
        frame(settings, background, planes)
    })?;
    antialias::apply(&changes, &mut frame);
    Ok(frame)
}

/// Linear values of all 8-bit values.
pub(crate) struct Linear([f32; 256]);

impl Linear {
    pub fn new() -> Self {
        Self(std::array::from_fn(|byte| {
            linear_from_srgb(byte as f64 / 255.0) as f32
        }))
    }

    /// The linear colour of a pixel.
    pub fn color(&self, &[r, g, b, a]: &[u8; 4]) -> [f32; 4] {
        let [r, g, b] = [r, g, b].map(|byte| self.0[usize::from(byte)]);
        [r, g, b, f32::from(a) / 255.0]
    }
}

fn vec4(bytes: &[u8], pixel: usize) -> [f32; 4] {
    bytemuck::pod_read_unaligned(&bytes[16 * pixel..16 * pixel + 16])
}
