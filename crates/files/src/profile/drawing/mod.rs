//! Profiles from SVG drawings: everything dark is solid, exactly along the drawn curves.
//!
//! Every fill and stroke becomes a region of the plane, with curves flattened within 1e-5 of the
//! drawing's height. Regions are laid over those painted before. The solid is everything darker
//! than one half over white. Groups, `use`, transforms, opacity, clip paths, dashes, caps, joins
//! and markers count. A gradient counts if its stops are all dark or all light, or make no
//! difference. Text, pictures, patterns, masks, filters and blend modes have no outline here and
//! are refused by name.

pub(crate) mod canvas;
mod dark;
mod paint;
mod thin_strokes;
mod tile;

use super::ProfileAxis;
use super::advice::{EMPTY, Way};
use super::seeming::{DRAWING, Silhouette, loop_length};
use crate::content_fault;
use crate::faults::{empty_fault, full_fault, half_empty_fault};
use canvas::{Canvas, FLATNESS};
use glam::DVec2;
use kurbo::{Affine, Point};
use paint::{Paint, gradients, lightened};
use revmap::error::Result;
use revmap::profile::{Grid, Outline, Profile, Region, loop_area};
use std::cell::Cell;
use tile::Tile;

/// Places of less than this area are small, square object units.
const SMALL: f64 = 2e-3;

/// All paint over the dark paint's area: pale paint is then the shape, or a part of it.
const MUCH: f64 = 2.0;
const SOME: f64 = 1.1;

/// A profile from the text of an SVG drawing (or its gzip-compressed form). Strokes thinner than
/// `min_stroke`, in heights, are left out.
pub(super) fn profile(bytes: &[u8], way: Way, min_stroke: f64) -> Result<Profile> {
    let axis = way.axis;
    let drawing = revmap_drawing::read(bytes).map_err(|e| content_fault(e.to_string()))?;
    let (width, height) = drawing.size;
    let (fraction, wide) = (axis.fraction(), width / height);
    let (left, radius) = (fraction * width, (1.0 - fraction) * wide);
    let page = Affine::new([1.0 / height, 0.0, 0.0, -1.0 / height, -left / height, 1.0]);
    let canvas = Canvas {
        low: DVec2::new(-fraction * wide, 0.0),
        high: DVec2::new(radius, 1.0),
        grid: Grid::for_extent(radius.max(1.0)),
        two_tone: way.pale || !drawing.has_translucency(),
        tinted: way.pale,
        min_stroke,
        page,
        cuts: Cell::new(false),
    };
    let paints = canvas.paints(&drawing.content, page)?;
    if paints.is_empty() && min_stroke > 0.0 {
        return Err(content_fault(
            "all shapes of the drawing are thin strokes, which are left out; give a smaller profile_min_stroke",
        ));
    }
    if paints.is_empty() {
        return Err(content_fault(
            "the drawing has no shape; draw the solid dark on white",
        ));
    }
    let tile = canvas.tile();
    let whole = tile.dark(&paints)?;
    let mut warnings = drawing.warnings;
    warnings.extend(check_gradients(&paints, &whole, tile)?);
    let user = |x: f64| {
        (drawing.to_user * page.inverse() * Point::new(x / DRAWING - left / height, 0.0)).x
    };
    let place = |x: f64| format!("x = {:.4}", user(x));
    let page_at = [left / height, wide];
    let strokes = canvas.thin_strokes(&drawing.content);
    let rest = match strokes.is_empty() {
        true => None,
        false => Some(canvas.without_thin().dark_region(&drawing.content)?),
    };
    let mut seen = whole.outline(canvas.grid);
    let mut cuts = Vec::new();
    if canvas.cuts.get()
        && let Ok(all) = canvas.beyond().dark(&drawing.content)
    {
        seen = all;
        seen.loops.retain(|l| canvas.shows(l));
        cuts = canvas.cut_edges(&seen);
    }
    let paler = |least| match way.pale {
        true => None,
        false => canvas.pale(&drawing.content, seen.area(), least),
    };
    let pale = || paler(MUCH);
    let form = Silhouette::of_outline(&seen, page_at, &place);
    let solid = rest.as_ref().map(|rest| rest.outline(canvas.grid));
    let silhouette = |outline| Silhouette::of_outline(outline, page_at, &place);
    let solid = solid.as_ref().map(silhouette);
    let marks = rest.as_ref();
    let marks = marks.and_then(|rest| canvas.marks(&strokes, &whole, rest));
    let half = match axis {
        ProfileAxis::Left => whole,
        ProfileAxis::Center | ProfileAxis::At(_) => {
            let right = Region::rectangle(canvas.grid, DVec2::ZERO, canvas.high);
            whole.intersection(&right)
        }
    };
    let mut profile = Profile::new(on_cylinder(half.outline(canvas.grid), &canvas), radius);
    without_slivers(&mut profile.outline);
    let outline = &profile.outline;
    if outline.area() <= 0.0 {
        let aside = solid.as_ref().unwrap_or(&form).elsewhere(axis);
        let aside = aside.map(|aside| half_empty_fault(&aside));
        let pale = || pale().map(|pale| content_fault(format!("{EMPTY}{pale}")));
        let lines = rest.as_ref().filter(|rest| rest.is_empty()).map(|_| {
            content_fault("the lines of the drawing are too thin to be solid; fill the shape")
        });
        return Err(aside
            .or_else(pale)
            .or(lines)
            .unwrap_or_else(|| empty_fault("drawing")));
    }
    if outline.area() >= radius * (1.0 - 1e-9) {
        return Err(full_fault("drawing"));
    }
    let marks = marks.filter(|_| pale().is_none());
    warnings.extend(match (form.is_light_on_dark(), marks) {
        (true, _) => vec![
            "the drawing looks like a light solid on dark ground; draw the solid dark on white if light is solid"
                .to_owned(),
        ],
        (false, Some(marks)) => {
            let hint = solid.and_then(|solid| solid.axis_hint(axis));
            marks.into_iter().chain(hint).collect()
        }
        (false, None) => {
            let mut hints = form.hints(outline, axis, pale);
            if hints.is_empty() {
                // Pale lines are a frame or a grid.
                hints.extend(paler(SOME).filter(|pale| pale.contains(" fill ")));
            }
            hints.extend(cuts.iter().map(|edge| {
                format!("the drawing is cut by the {edge} edge of the page; move it into the page, or enlarge the page")
            }));
            hints
        }
    });
    profile.warnings = warnings;
    Ok(profile)
}

/// Refuses gradients whose light parts would be solid, or whose dark parts would not. Small places
/// bring a warning, and so do gradients that are dark and light only with translucent paint over
/// them.
fn check_gradients(paints: &[Paint], darkest: &Region, tile: Tile) -> Result<Option<String>> {
    let lines = gradients(paints);
    let difference = |chosen: &dyn Fn(u32) -> bool| -> Result<f64> {
        let lighter = tile.dark(&lightened(paints, chosen))?;
        Ok(darkest.difference(&lighter).outline(tile.grid).area())
    };
    if lines.is_empty() || difference(&|_| true)? <= FLATNESS {
        return Ok(None);
    }
    let strong = |line: u32| lines.contains(&(line, true));
    let refused = difference(&strong)? > SMALL;
    let mut named = (0.0, lines[0].0);
    for &(line, is_strong) in lines.iter().take(8) {
        let own = difference(&|l| l == line)?;
        if own > named.0 && (is_strong || !refused) {
            named = (own, line);
        }
    }
    let line = named.1;
    if !refused {
        return Ok(Some(format!(
            "the drawing has a gradient (line {line}) that is dark and light in places; one colour counts for it"
        )));
    }
    Err(content_fault(format!(
        "the drawing uses a gradient from dark to light (line {line}), which has no outline here; give the shape one \
         flat colour"
    )))
}

/// The outline with the viewport's right border on the cylinder, to the last bit.
fn on_cylinder(mut outline: Outline, canvas: &Canvas) -> Outline {
    let edge = canvas.grid.rounded(canvas.high).x;
    for p in outline.loops.iter_mut().flatten() {
        if p.x == edge {
            p.x = canvas.high.x;
        }
    }
    outline
}

/// Drops loops thinner than the flattening tolerance. Rounding leaves cracks and specks between
/// abutting shapes, and each would become a surface.
fn without_slivers(outline: &mut Outline) {
    let is_thick = |points: &Vec<DVec2>| loop_area(points).abs() > FLATNESS * loop_length(points);
    outline.loops.retain(is_thick);
}
