//! The catalogue.

mod boxes;
mod light;
mod maps;
mod placement;
mod rays;
mod shapes;

use super::case::Case;
use crate::report::folder::png;
use crate::report::folder::{make, write_bytes};
use revmap::error::{Error, ErrorKind, Result};
use revmap_files::Picture;
use std::path::Path;

/// Every case, in the order of the table.
#[must_use]
pub fn all() -> Vec<Case> {
    let mut all = placement::cases();
    all.extend(shapes::cases());
    all.extend(rays::cases());
    all.extend(boxes::cases());
    all.extend(light::cases());
    all.extend(maps::cases());
    all
}

/// The cases of these names; all where none is named.
///
/// # Errors
/// [`ErrorKind::Usage`] for a name that no case has.
pub fn named(names: &[String]) -> Result<Vec<Case>> {
    let all = all();
    for name in names {
        if !all.iter().any(|case| case.name == name) {
            let known: Vec<_> = all.iter().map(|case| case.name).collect();
            return Err(Error::new(
                ErrorKind::Usage,
                format!("{name:?} is no case; give some of {}", known.join(", ")),
            ));
        }
    }
    let wanted = |case: &Case| names.is_empty() || names.iter().any(|n| n == case.name);
    Ok(all.into_iter().filter(wanted).collect())
}

/// A case without scenes.
fn case(
    name: &'static str,
    parameter: &'static str,
    why: &'static str,
    cure: &'static str,
) -> Case {
    Case {
        name,
        parameter,
        why,
        cure,
        steps: Vec::new(),
        known: Vec::new(),
        motion: false,
    }
}

/// Writes the pictures that cases name into `folder`.
///
/// # Errors
/// When a file cannot be written.
pub fn write_files(folder: &Path) -> Result<()> {
    make(folder)?;
    for side in shapes::PICTURE_ROWS {
        let name = format!("border-{side}.png");
        let picture = shapes::bordered(side);
        write_bytes(&folder.join(name), &png(&picture)?)?;
        let name = format!("ball-{side}.png");
        write_bytes(&folder.join(name), &png(&shapes::binary_ball(side))?)?;
    }
    write_bytes(&folder.join("waves.png"), &png(&maps::waves())?)
}

/// A grey picture; `dark` tells which pixels are solid.
fn silhouette(width: u32, height: u32, dark: impl Fn(u32, u32) -> bool) -> Picture {
    let pixel = |k: u32| {
        let shade = if dark(k % width, k / width) { 0 } else { 255 };
        [shade, shade, shade, 255]
    };
    Picture {
        width,
        height,
        rgba: (0..width * height).map(pixel).collect(),
    }
}

/// A spindle with a waist: curved, slanting, level and upright parts.
pub(super) const SPINDLE: [[f64; 2]; 8] = [
    [0.0, 0.05],
    [0.35, 0.05],
    [0.35, 0.15],
    [0.12, 0.3],
    [0.18, 0.55],
    [0.3, 0.7],
    [0.2, 0.95],
    [0.0, 0.95],
];

/// A thin-walled glass with foot and stem: walls of 0.015.
pub(super) const GLASS: [[f64; 2]; 12] = [
    [0.0, 0.04],
    [0.26, 0.04],
    [0.26, 0.06],
    [0.04, 0.1],
    [0.035, 0.4],
    [0.18, 0.5],
    [0.3, 0.7],
    [0.28, 0.95],
    [0.265, 0.95],
    [0.285, 0.7],
    [0.17, 0.52],
    [0.0, 0.44],
];

/// A ball of 96 segments about the middle of the box.
pub(super) fn ball(radius: f64) -> Vec<[f64; 2]> {
    (0..=96)
        .map(|k| {
            let angle = std::f64::consts::PI * (f64::from(k) / 96.0 - 0.5);
            let r = if k == 0 || k == 96 {
                0.0
            } else {
                radius * angle.cos()
            };
            [r, 0.5 + radius * angle.sin()]
        })
        .collect()
}

/// A cylinder on its box's floor.
pub(super) fn cylinder(radius: f64, low: f64, high: f64) -> Vec<[f64; 2]> {
    vec![[0.0, low], [radius, low], [radius, high], [0.0, high]]
}

/// An eye that looks at the middle of a box of height 1 from `distance`, `elevation` degrees up.
pub(super) fn eye(elevation: f64, distance: f64) -> [f64; 3] {
    let (s, c) = elevation.to_radians().sin_cos();
    [0.93 * c * distance, 0.37 * c * distance, s * distance + 0.5]
}

/// The middle of a box at the origin.
pub(super) const MIDDLE: [f64; 3] = [0.0, 0.0, 0.5];
