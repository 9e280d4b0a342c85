//! Warnings about gaps so narrow that nobody sees them, though an inset makes grooves of them.

use glam::{DVec2, Vec2Swizzles as _};
use revmap::profile::Outline;

/// A gap between solid and axis below this part of the height is not meant.
pub(crate) const BORE: f64 = 1e-2;
/// A gap between two parts of the solid below this part of the height is not meant.
const SEAM: f64 = 1e-3;
/// Gaps below this come from rounding.
const ROUNDING: f64 = 1e-8;
/// Lines across the outline in each direction.
const LINES: usize = 1024;
/// Lines that a gap of even width must cross.
const LEAST: usize = 16;

/// Warnings about the outline of a half, in heights.
pub(crate) fn hints(half: &Outline) -> Vec<String> {
    let across = lines(half);
    let bore = across.iter().filter_map(|line| line.first().copied());
    let bore = even(bore.filter(|r| *r > 0.0 && *r < BORE)).map(|gap| {
        format!("the solid is {gap} of the height away from the axis, which makes a bore; move its points to the axis if none is meant")
    });
    let along = lines(&turned(half));
    let seams = across.iter().chain(&along).flat_map(|line| {
        let between = line.get(1..).unwrap_or_default().chunks_exact(2);
        between.map(|pair| pair[1] - pair[0])
    });
    let seam = even(seams.filter(|gap| *gap > ROUNDING && *gap < SEAM)).map(|gap| {
        format!("two parts of the solid are {gap} of the height apart; let them overlap if no groove is meant")
    });
    bore.into_iter().chain(seam).collect()
}

/// The outline with its axes exchanged.
pub(crate) fn turned(outline: &Outline) -> Outline {
    let turned = |l: &Vec<DVec2>| l.iter().rev().map(|p| p.yx()).collect();
    Outline {
        loops: outline.loops.iter().map(turned).collect(),
    }
}

/// Places at which lines cross the outline, from the lowest to the highest point.
fn lines(outline: &Outline) -> Vec<Vec<f64>> {
    let Some(b) = outline.bounds() else {
        return Vec::new();
    };
    let at = |k: usize| b.z_min + (b.z_max - b.z_min) * (k as f64 + 0.5) / LINES as f64;
    outline.crossings((0..LINES).map(at))
}

/// The width of gaps that are equally wide, in three digits. Gaps that taper, such as the end of a
/// hollow, have none.
fn even(gaps: impl Iterator<Item = f64>) -> Option<String> {
    let mut gaps: Vec<f64> = gaps.collect();
    gaps.sort_by(f64::total_cmp);
    let width = *gaps.get(gaps.len() / 2)?;
    let equal = gaps
        .iter()
        .filter(|gap| (**gap - width).abs() <= 0.1 * width);
    let digits: f64 = format!("{width:.2e}").parse().unwrap_or(width);
    (equal.count() >= LEAST).then(|| format!("{digits}"))
}
