//! Textures of a surface, directly by the formulas (method: sections 5 and 6): texture coordinates
//! of each projection, and the colour and slope at them. Gradients of the coordinates are
//! differences of the formulas, so that nothing here repeats the derivations used in shaders.

use super::shared;
use glam::DVec3;
use revmap::error::Result;
use revmap::frame::linear_from_srgb;
use revmap::maps::{ArcLength, Level, Projection};
use revmap::scene::{BumpForm, Object, Scene};
use std::f64::consts::{PI, TAU};
use std::sync::Arc;

/// Arc lengths along the profiles of those objects whose texture uses them.
#[derive(Debug)]
pub(super) struct Lengths(Vec<Option<Arc<ArcLength>>>);

impl Lengths {
    pub fn new(scene: &Scene) -> Result<Self> {
        let mut known = Vec::new();
        let length = |object: &Object| {
            let wanted = object.texturing.projection == Projection::Arc;
            let length = wanted.then(|| shared(&mut known, &object.profile, ArcLength::new));
            length.transpose()
        };
        Ok(Self(
            scene.objects.iter().map(length).collect::<Result<_>>()?,
        ))
    }

    pub fn of(&self, object: usize) -> Option<&ArcLength> {
        self.0.get(object)?.as_deref()
    }
}

/// `(xi, eta)` at a point of a replica's cell, about its axis, before the texture's repetition and offset.
pub(super) fn coordinates(object: &Object, arc: Option<&ArcLength>, p: DVec3) -> [f64; 2] {
    let radius = object.profile.radius;
    let r = p.x.hypot(p.y);
    let xi = 0.5 + p.y.atan2(p.x) / TAU;
    match object.texturing.projection {
        Projection::Planar => [
            object.axis[0] + p.x / (2.0 * radius),
            object.axis[1] + p.y / (2.0 * radius),
        ],
        Projection::Cylindrical => [xi, p.z],
        Projection::Spherical => [xi, 1.0 - r.atan2(p.z - 0.5) / PI],
        Projection::Arc => [xi, arc.map_or(p.z, |a| a.eta(r, p.z))],
    }
}

/// The colour map's light at texture coordinates, from only the full size: bilinear between texels,
/// no smaller levels.
pub(super) fn color(object: &Object, uv: [f64; 2]) -> Option<[f64; 3]> {
    let level = object.texturing.color_map.as_ref()?.levels.first()?;
    Some(bilinear(object, level, uv, |t| {
        [t[0], t[1], t[2]].map(|v| linear_from_srgb(f64::from(v) / 255.0))
    }))
}

/// The height's change along the surface at `p`, with outward unit normal `n`; all in the cell's
/// own units.
pub(super) fn slope(object: &Object, arc: Option<&ArcLength>, p: DVec3, n: DVec3) -> Option<DVec3> {
    let look = &object.texturing;
    let level = look.displacement_map.as_ref()?.levels.first()?;
    let uv = coordinates(object, arc, p);
    let [du, dv] = bilinear(object, level, uv, |t| t.map(f64::from));
    let [du, dv] = [du * look.repeat[0], dv * look.repeat[1]];
    let gradient = match look.bump_form {
        BumpForm::SurfaceGradient => {
            let mut gradient = DVec3::ZERO;
            for (axis, unit) in DVec3::AXES.into_iter().enumerate() {
                let step = 1e-6;
                let after = coordinates(object, arc, p + step * unit);
                let before = coordinates(object, arc, p - step * unit);
                // The azimuth, and the length along a closed contour, jump by 1.
                let change = [0, 1].map(|k| {
                    let d: f64 = after[k] - before[k];
                    (d - d.round()) / (2.0 * step)
                });
                gradient[axis] = du * change[0] + dv * change[1];
            }
            gradient
        }
        BumpForm::Papers => {
            let around = DVec3::new(-p.y, p.x, 0.0).normalize_or(DVec3::Y);
            du * around + dv * n.cross(around)
        }
    };
    Some(gradient - n * n.dot(gradient))
}

/// The mean of the four texels around a point, weighted by nearness. Textures always repeat across.
/// Along, they repeat if the object repeats them or if they are projected from above.
fn bilinear<T: Copy, const N: usize>(
    object: &Object,
    level: &Level<T>,
    uv: [f64; 2],
    value: impl Fn(T) -> [f64; N],
) -> [f64; N] {
    let look = &object.texturing;
    let (w, h) = (f64::from(level.width), f64::from(level.height));
    let x = (uv[0] * look.repeat[0] - look.offset[0]) * w - 0.5;
    let y = ((1.0 - uv[1]) * look.repeat[1] + look.offset[1]) * h - 0.5;
    let clamped = look.clamps();
    let mut sum = [0.0; N];
    for (i, j) in [(0.0, 0.0), (1.0, 0.0), (0.0, 1.0), (1.0, 1.0)] {
        let (column, row) = (x.floor() + i, y.floor() + j);
        let weight = (1.0 - (x - column).abs()) * (1.0 - (y - row).abs());
        let column = column.rem_euclid(w);
        let row = if clamped {
            row.clamp(0.0, h - 1.0)
        } else {
            row.rem_euclid(h)
        };
        let index = row as usize * level.width as usize + column as usize;
        if let Some(&texel) = level.texels.get(index) {
            for (s, v) in sum.iter_mut().zip(value(texel)) {
                *s += weight * v;
            }
        }
    }
    sum
}
