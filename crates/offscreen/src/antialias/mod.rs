//! Anti-aliasing of silhouettes from the solids themselves, for a frame of one ray per pixel.
//!
//! Silhouettes of a solid, and the rims where its surface bends, are lines in closed form, computed
//! from the solid's patches. The algorithm walks along each line on the screen. Each pixel that the
//! line cuts keeps its own colour for the part on its middle's side. The neighbour across the line
//! gives the rest. A hidden line has no effect: the frame's distances show that it is hidden.
//!
//! Nothing is traced, and pixels that no line cuts are not read. The cost is therefore proportional
//! to the length of the silhouettes. Smoothing needs only the planes of a [`Frame`], from any
//! renderer: either stage, any search, the reference.
//!
//! Colours within a surface are unchanged: textures, highlights and shadows are not smoothed. Lines
//! where two solids cut each other, and replicas, are not smoothed either.

mod coverage;
mod lines;
mod meridian;

pub use coverage::coverage;

use coverage::{Blend, Screen};
use glam::{DVec2, DVec3};
use lines::Sight;
use meridian::Meridian;
use rayon::prelude::*;
use revmap::error::Result;
use revmap::frame::Frame;
use revmap::scene::{CameraFrame, Object, Placement, Scene};

/// Smooths the silhouettes of a frame of this scene. The frame must have distances; an infinite
/// distance is background.
///
/// # Errors
/// The errors of the scene's camera.
pub fn silhouettes(scene: &Scene, frame: &mut Frame) -> Result<()> {
    let mut solids = Solids::default();
    solids.update(scene);
    let camera = CameraFrame::new(&scene.camera, frame.width, frame.height)?;
    solids.smooth(&camera, frame);
    Ok(())
}

/// The number of a pixel that smoothing changes, and the pixel's new colour.
pub(crate) type Change = (u32, [f32; 4]);

/// The solids of a scene, prepared; unchanged solids are reused.
#[derive(Default)]
pub(crate) struct Solids {
    of: Vec<(Object, Option<Meridian>)>,
}

impl Solids {
    /// Updates the solids to a scene. Objects whose contour does not close are left out.
    pub fn update(&mut self, scene: &Scene) {
        let mut known = std::mem::take(&mut self.of).into_iter();
        for object in &scene.objects {
            let unchanged = known.next().filter(|(known, _)| known == object);
            let made = || (object.clone(), Meridian::new(object).ok().flatten());
            self.of.push(unchanged.unwrap_or_else(made));
        }
    }

    /// Smooths a frame by its distances.
    pub fn smooth(&self, camera: &CameraFrame, frame: &mut Frame) {
        let (size, distance) = ((frame.width, frame.height), &frame.distance);
        #[allow(clippy::cast_possible_truncation)] // columns and rows
        let depth = |pixel: usize| {
            let (x, y) = (pixel as u32 % size.0, pixel as u32 / size.0);
            f64::from(distance[pixel]) / camera.pixel(x, y).length()
        };
        let color = |pixel: usize| frame.color[pixel];
        let changes = self.changes(camera, size, &depth, &color);
        apply(&changes, frame);
    }

    /// The pixels that smoothing changes in a picture. `depth` returns the depth of a pixel along
    /// the view, infinite for the background; `color` returns the pixel's colour.
    pub fn changes<D, C>(
        &self,
        camera: &CameraFrame,
        size: (u32, u32),
        depth: &D,
        color: &C,
    ) -> Vec<Change>
    where
        D: Fn(usize) -> f64 + Sync,
        C: Fn(usize) -> [f32; 4],
    {
        let blends = self.blends(camera, size, depth);
        blends
            .iter()
            .map(|b| (b.pixel(), mixed(b, color)))
            .collect()
    }

    /// The blends of pixels that show their neighbours in part; each pixel once.
    fn blends<D>(&self, camera: &CameraFrame, size: (u32, u32), depth: &D) -> Vec<Blend>
    where
        D: Fn(usize) -> f64 + Sync,
    {
        let screen = Screen {
            width: size.0,
            height: size.1,
            depth,
            pixel_size: camera.right.length(),
        };
        let add = |mut blends: Vec<Blend>, solid: &Meridian, copy: &Placement| {
            let (size, middle) = (solid.size(copy), middle(copy) - camera.eye);
            let depth = middle.dot(camera.forward);
            let step = [camera.right, -camera.up].map(|v| middle.dot(v) / v.length_squared());
            let at = DVec2::from(camera.middle) + DVec2::from(step) / depth;
            if depth > -size && screen.may_show(at, depth, size) {
                let nearest = (depth - size).max(1e-3 * size);
                let pixels = copy.scale.max_element() / (camera.right.length() * nearest);
                let sight = Sight::new(camera, copy, solid.object.axis_offset().into());
                let mut add = |a: &_, b: &_| screen.line(a, b, &mut blends);
                sight.lines(solid.patches(pixels), &mut add);
            }
            blends
        };
        let joined = |mut a: Vec<Blend>, b| {
            if a.is_empty() {
                return b;
            }
            a.extend(b);
            a
        };
        let mut all = Vec::new();
        for solid in self.of.iter().filter_map(|(_, solid)| solid.as_ref()) {
            let copies = solid.object.placements().par_iter().with_min_len(16);
            let parts = copies.fold(Vec::new, |blends, copy| add(blends, solid, copy));
            all = joined(all, parts.reduce(Vec::new, joined));
        }
        Blend::leave_one_a_pixel(&mut all);
        all
    }
}

/// The middle of a copy's box.
fn middle(copy: &Placement) -> DVec3 {
    copy.position + copy.rotation * (0.5 * copy.scale * DVec3::Z)
}

/// The colours of a blend's sources, mixed and weighted by alpha.
fn mixed(blend: &Blend, color: &impl Fn(usize) -> [f32; 4]) -> [f32; 4] {
    let [beyond, own, further] = blend.sources.map(|(pixel, weight)| {
        let [r, g, b, a] = color(pixel as usize);
        ([r * a, g * a, b * a, a], weight)
    });
    let covered = own.1 + further.1;
    let [r, g, b, a]: [f32; 4] = std::array::from_fn(|c| {
        let (a, b) = (own.0[c], further.0[c]);
        let near = a * own.1 + b * further.1;
        // The mix with the colour from further in is at least half of the smaller and at most the
        // larger of the two.
        let [least, most] = [0.5 * a.min(b), a.max(b)].map(|v| covered * v);
        beyond.0[c] * beyond.1 + near.max(least).min(most)
    });
    let scale = if a > 0.0 { a.recip() } else { 0.0 };
    [r * scale, g * scale, b * scale, a.min(1.0)]
}

/// Writes the changes of smoothing into the frame.
pub(crate) fn apply(changes: &[Change], frame: &mut Frame) {
    for (pixel, color) in changes {
        frame.color[*pixel as usize] = *color;
    }
}
