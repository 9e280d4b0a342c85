//! Draws a whole picture by the reference, rows in parallel; any number of threads gives the same
//! bits.

use super::shade::Colors;
use super::{Ray, Reference};
use glam::DVec3;
use rayon::prelude::*;
use revmap::error::Result;
use revmap::frame::Frame;
use revmap::host_memory;
use revmap::scene::{CameraFrame, Scene};
use revmap::settings::Settings;
use std::sync::atomic::{AtomicUsize, Ordering};

/// Draws a scene in double precision on the CPU. Only the size of the settings is used.
///
/// `progress` is called, from any thread, with the number of finished rows and the number of all
/// rows.
pub fn draw(
    scene: &Scene,
    settings: &Settings,
    progress: &(dyn Fn(usize, usize) + Sync),
) -> Result<Frame> {
    let (width, height) = (settings.width, settings.height);
    let mut frame = Frame::new(width, height, scene.background)?;
    let camera = CameraFrame::new(&scene.camera, width, height)?;
    let reference = Reference::new(scene)?;
    let colors = Colors::new(scene)?;
    let done = AtomicUsize::new(0);
    let rows: Result<Vec<Vec<_>>> = (0..height)
        .into_par_iter()
        .map(|j| {
            let mut row = host_memory::reserved(width as usize, "a row of the reference")?;
            row.extend((0..width).filter_map(|i| {
                let value = pixel(scene, &reference, &colors, camera.pixel(i, j))?;
                Some((i, value))
            }));
            progress(done.fetch_add(1, Ordering::Relaxed) + 1, height as usize);
            Ok(row)
        })
        .collect();
    for (j, row) in rows?.into_iter().enumerate() {
        for (i, value) in row {
            let index = j * width as usize + i as usize;
            frame.set_pixel(index, value);
        }
    }
    Ok(frame)
}

/// All channels of a pixel, in the order of [`revmap::frame::CHANNELS`]; `None` if the ray enters
/// no box.
fn pixel(
    scene: &Scene,
    reference: &Reference,
    colors: &Colors,
    direction: DVec3,
) -> Option<[f32; 17]> {
    let ray = Ray::new(scene.camera.eye, direction);
    let trace = reference.trace(ray);
    let steps = trace.evaluations as f32;
    let Some(hit) = trace.hit else {
        let [r, g, b, a] = scene.background;
        let mut value = [0.0; 17];
        value[..5].copy_from_slice(&[r, g, b, a, f32::INFINITY]);
        value[16] = steps;
        return (trace.evaluations > 0).then_some(value);
    };
    let shaded = colors.shade(reference, &hit, ray, 0.0)?;
    let [r, g, b, a] = shaded.color;
    let [nx, ny, nz] = hit.normal.as_vec3().to_array();
    let [sx, sy, sz] = shaded.shading_normal.as_vec3().to_array();
    let [ar, ag, ab] = shaded.albedo;
    let z = (hit.t * direction.length()) as f32;
    let [u, v] = shaded.uv.map(|x| x as f32);
    Some([
        r, g, b, a, z, nx, ny, nz, sx, sy, sz, ar, ag, ab, u, v, steps,
    ])
}
