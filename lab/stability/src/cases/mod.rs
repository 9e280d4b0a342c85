//! The catalogue.

mod polycones;
mod solids;
mod views;

use super::case::{Case, Step};
use revmap::error::{Error, ErrorKind, Result};
use revmap_compare::mosaic::painted;
use revmap_figures::files::{make, png, write_bytes};
use revmap_files::Picture;
use std::path::Path;

/// The scene of a case at a value of its parameter.
type Scene = (&'static str, fn(f64) -> Step);

/// The cases of these names, in the order of the table; all where none is named.
///
/// # Errors
/// [`ErrorKind::Usage`] for a name that no case has.
pub fn named(names: &[String]) -> Result<Vec<Case>> {
    #[derive(serde::Deserialize)]
    struct Catalogue {
        case: Vec<Case>,
    }
    let catalogue = toml::from_str(include_str!("../cases.toml"));
    let Catalogue { case: mut all } = catalogue.map_err(|error| broken(&error))?;
    let is_known = |name: &&String| all.iter().any(|case| case.name == **name);
    if let Some(name) = names.iter().find(|name| !is_known(name)) {
        let known: Vec<_> = all.iter().map(|case| case.name.as_str()).collect();
        let message = format!("{name:?} is no case; give some of {}", known.join(", "));
        return Err(Error::new(ErrorKind::Usage, message));
    }
    all.retain(|case| names.is_empty() || names.contains(&case.name));
    Ok(all)
}

fn broken(why: &dyn std::fmt::Display) -> Error {
    Error::new(ErrorKind::Other, format!("cases.toml: {why}"))
}

/// The scene of a case at a value of its parameter.
pub(super) fn step(case: &Case, value: f64) -> Result<Step> {
    let mut scenes = (views::SCENES.iter())
        .chain(solids::SCENES)
        .chain(polycones::SCENES);
    let scene = scenes.find(|s| s.0 == case.name);
    let scene = scene.ok_or_else(|| broken(&format!("{} has no scene", case.name)))?;
    Ok(scene.1(value))
}

/// Writes the pictures that cases name into `folder`.
pub fn write_files(folder: &Path) -> Result<()> {
    make(folder)?;
    for side in solids::PICTURE_ROWS {
        let (border, ball) = (solids::bordered(side), solids::binary_ball(side));
        write_bytes(&folder.join(format!("border-{side}.png")), &png(&border)?)?;
        write_bytes(&folder.join(format!("ball-{side}.png")), &png(&ball)?)?;
    }
    write_bytes(&folder.join("waves.png"), &png(&solids::waves())?)
}

/// A grey picture; `dark` tells which pixels are solid.
fn silhouette(width: u32, height: u32, dark: impl Fn(u32, u32) -> bool) -> Picture {
    painted([width as usize, height as usize], |x, y| {
        let shade = if dark(x as u32, y as u32) { 0 } else { 255 };
        [shade, shade, shade, 255]
    })
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

/// Point `k` of `count` and one more on a half turn about the middle of the box, `radius` away.
pub(super) fn on_half_turn(k: usize, count: usize, radius: f64) -> [f64; 2] {
    let angle = std::f64::consts::PI * (k as f64 / count as f64 - 0.5);
    let end = k == 0 || k == count;
    let r = if end { 0.0 } else { radius * angle.cos() };
    [r, 0.5 + radius * angle.sin()]
}

/// A ball of 96 segments about the middle of the box.
pub(super) fn ball(radius: f64) -> Vec<[f64; 2]> {
    (0..=96).map(|k| on_half_turn(k, 96, radius)).collect()
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

/// A spindle from `elevation` degrees up and a distance; `keys` are further lines of the object.
pub(super) fn spindle(elevation: f64, distance: f64, keys: &str) -> Step {
    Step::seen(eye(elevation, distance), MIDDLE).solid(&SPINDLE, keys)
}
