//! Profiles from SVG drawings: everything dark is solid, exactly along the drawn curves.
//!
//! Every fill and stroke becomes a region of the plane, with curves flattened within 1e-5 of the
//! drawing's height. Regions are laid over those painted before. The solid is everything darker
//! than one half over white. Groups, `use`, transforms, opacity, clip paths, dashes, caps and joins
//! count. A gradient counts as the mean of its stops, provided that these are all dark or all
//! light. Text, pictures, patterns, masks, filters and blend modes have no outline here and are
//! refused by name.

use super::paint::{Layer, Rgba, over};
use super::svg::{
    affine, curve, gradient, has_translucency, magnification, parse, rule, stroke_style,
    unsupported,
};
use super::{ProfileAxis, empty_fault, full_fault};
use crate::content_fault;
use crate::pixels::luminance;
use glam::DVec2;
use kurbo::{Affine, BezPath, PathEl, Shape, StrokeOpts};
use revmap::error::Result;
use revmap::profile::{FillRule, Grid, Outline, Profile, Region, loop_area};

/// Largest distance between a curve and its chords, object units.
const FLATNESS: f64 = 1e-5;

/// A profile from the text of an SVG drawing (or its gzip-compressed form).
pub(super) fn profile(bytes: &[u8], axis: ProfileAxis) -> Result<Profile> {
    let tree = parse(bytes)?;
    let (width, height) = (
        f64::from(tree.size().width()),
        f64::from(tree.size().height()),
    );
    let (left, radius) = match axis {
        ProfileAxis::Left => (0.0, width / height),
        ProfileAxis::Center => (0.5 * width, 0.5 * width / height),
        ProfileAxis::At(fraction) => (fraction * width, (1.0 - fraction) * width / height),
    };
    let to_profile = Affine::new([1.0 / height, 0.0, 0.0, -1.0 / height, -left / height, 1.0]);
    let canvas = Canvas {
        radius,
        grid: Grid::for_extent(radius.max(1.0)),
        two_tone: !has_translucency(tree.root()),
    };
    let mut layer = Layer::default();
    let shapes = canvas.draw_children(tree.root(), to_profile, &mut layer)?;
    if shapes == 0 {
        return Err(content_fault(
            "the drawing has no shape; draw the solid dark on white",
        ));
    }
    let cells = layer.into_cells().into_iter();
    let dark = cells.filter(|(color, _)| is_dark(*color));
    let solid = Region::merged(dark.map(|(_, region)| region));
    let mut outline = solid.outline(canvas.grid);
    // The viewport's right border is the cylinder, to the last bit.
    let edge = canvas.grid.rounded(DVec2::new(radius, 0.0)).x;
    for p in outline.loops.iter_mut().flatten() {
        if p.x == edge {
            p.x = radius;
        }
    }
    let outline = without_slivers(outline);
    if outline.area() <= 0.0 {
        return Err(empty_fault("drawing"));
    }
    if outline.area() >= radius * (1.0 - 1e-9) {
        return Err(full_fault("drawing"));
    }
    Ok(Profile::new(outline, radius))
}

/// Drops loops thinner than the flattening tolerance. Rounding leaves cracks and specks between
/// abutting shapes, and each would become a surface.
fn without_slivers(mut outline: Outline) -> Outline {
    outline.loops.retain(|points| {
        let next = points.iter().cycle().skip(1);
        let length: f64 = points.iter().zip(next).map(|(a, b)| a.distance(*b)).sum();
        loop_area(points).abs() > FLATNESS * length
    });
    outline
}

/// Returns true for a colour darker than one half over white.
fn is_dark(color: Rgba) -> bool {
    let [r, g, b, _] = over(color, [1.0; 4]);
    luminance([r, g, b]) < 0.5
}

/// The drawing area: the right half of the viewport, on the integer grid.
struct Canvas {
    radius: f64,
    grid: Grid,
    /// All paint is opaque, so dark and light are the only two colours needed.
    two_tone: bool,
}

impl Canvas {
    /// Paints a group's children onto the layer. `to_profile` maps the group's coordinates to
    /// `(r, z)`. Returns the number of fills and strokes.
    fn draw_children(
        &self,
        group: &usvg::Group,
        to_profile: Affine,
        layer: &mut Layer,
    ) -> Result<usize> {
        let mut count = 0;
        for node in group.children() {
            count += match node {
                usvg::Node::Group(inner) => {
                    self.draw_group(inner, to_profile * affine(inner.transform()), layer)?
                }
                usvg::Node::Path(path) if path.is_visible() => {
                    self.draw_path(path, to_profile, layer)?
                }
                usvg::Node::Path(_) => 0,
                usvg::Node::Image(_) => return Err(unsupported("<image>", "trace it to paths")),
                usvg::Node::Text(_) => return Err(unsupported("<text>", "convert it to paths")),
            };
        }
        Ok(count)
    }

    fn draw_group(
        &self,
        group: &usvg::Group,
        to_profile: Affine,
        layer: &mut Layer,
    ) -> Result<usize> {
        if group.mask().is_some() {
            return Err(unsupported("a mask", "clip with a path, or cut the shape"));
        }
        if !group.filters().is_empty() {
            return Err(unsupported("a filter", "remove it"));
        }
        if group.blend_mode() != usvg::BlendMode::Normal {
            return Err(unsupported("a blend mode", "set it to normal"));
        }
        let opacity = group.opacity().get();
        let clip = match group.clip_path() {
            Some(clip) => Some(self.clip_region(clip, to_profile)?),
            None => None,
        };
        if opacity >= 1.0 && clip.is_none() {
            return self.draw_children(group, to_profile, layer);
        }
        let mut own = Layer::default();
        let count = self.draw_children(group, to_profile, &mut own)?;
        for (color, cell) in own.into_cells() {
            let shown = clip.as_ref().map_or(cell.clone(), |c| cell.intersection(c));
            layer.paint(shown, color.map(|v| v * opacity));
        }
        Ok(count)
    }

    fn draw_path(&self, path: &usvg::Path, to_profile: Affine, layer: &mut Layer) -> Result<usize> {
        let curve = curve(path.data());
        check_reach(&curve, to_profile)?;
        let mut paints = Vec::new();
        if let Some(fill) = path.fill() {
            let region = self.enclosed(&curve, to_profile, FLATNESS, rule(fill.rule()));
            paints.push((region, self.color(fill.paint(), fill.opacity().get())?));
        }
        if let Some(stroke) = path.stroke() {
            let color = self.color(stroke.paint(), stroke.opacity().get())?;
            // Half of the tolerance is for the stroke's outline, half for its flattening.
            let tolerance = 0.5 * FLATNESS / magnification(to_profile);
            check_dashes(&curve, stroke)?;
            let (style, options) = (stroke_style(stroke), StrokeOpts::default());
            let band = kurbo::stroke(curve.iter(), &style, &options, tolerance);
            let region = self.enclosed(&band, to_profile, 0.5 * FLATNESS, FillRule::NonZero);
            paints.push((region, color));
        }
        if path.paint_order() == usvg::PaintOrder::StrokeAndFill {
            paints.reverse();
        }
        let count = paints.len();
        for (region, color) in paints {
            layer.paint(region, color);
        }
        Ok(count)
    }

    /// The union of a clip path's shapes, cut by its own clip path.
    fn clip_region(&self, clip: &usvg::ClipPath, to_profile: Affine) -> Result<Region> {
        let inner = to_profile * affine(clip.transform());
        let region = self.union_of(clip.root(), inner)?;
        match clip.clip_path() {
            Some(outer) => Ok(region.intersection(&self.clip_region(outer, to_profile)?)),
            None => Ok(region),
        }
    }

    fn union_of(&self, group: &usvg::Group, to_profile: Affine) -> Result<Region> {
        let mut regions = Vec::new();
        for node in group.children() {
            match node {
                usvg::Node::Group(g) => {
                    let inner = to_profile * affine(g.transform());
                    let mut region = self.union_of(g, inner)?;
                    if let Some(clip) = g.clip_path() {
                        region = region.intersection(&self.clip_region(clip, inner)?);
                    }
                    regions.push(region);
                }
                usvg::Node::Path(path) => {
                    if let Some(fill) = path.fill() {
                        let (curve, rule) = (curve(path.data()), rule(fill.rule()));
                        check_reach(&curve, to_profile)?;
                        let region = self.enclosed(&curve, to_profile, FLATNESS, rule);
                        regions.push(region);
                    }
                }
                usvg::Node::Image(_) | usvg::Node::Text(_) => {
                    return Err(unsupported("a clip that is no path", "clip with a path"));
                }
            }
        }
        Ok(Region::merged(regions))
    }

    /// The region of the viewport's right half that a path encloses.
    fn enclosed(
        &self,
        path: &BezPath,
        to_profile: Affine,
        flatness: f64,
        rule: FillRule,
    ) -> Region {
        let mut loops: Vec<Vec<DVec2>> = Vec::new();
        let mut points: Vec<DVec2> = Vec::new();
        let mut finish = |points: &mut Vec<DVec2>| {
            let inside = clip_to_box(std::mem::take(points), self.radius);
            if inside.len() >= 3 {
                loops.push(inside);
            }
        };
        kurbo::flatten(to_profile * path, flatness, |element| match element {
            PathEl::MoveTo(p) => {
                finish(&mut points);
                points.push(DVec2::new(p.x, p.y));
            }
            PathEl::LineTo(p) => points.push(DVec2::new(p.x, p.y)),
            PathEl::QuadTo(..) | PathEl::CurveTo(..) | PathEl::ClosePath => {}
        });
        finish(&mut points);
        Region::enclosed(self.grid, &loops, rule)
    }

    /// The colour of a paint, premultiplied.
    fn color(&self, paint: &usvg::Paint, opacity: f32) -> Result<Rgba> {
        let plain = |c: usvg::Color, a: f32| -> Rgba {
            let [r, g, b] = [c.red, c.green, c.blue].map(|v| f32::from(v) / 255.0 * a);
            [r, g, b, a]
        };
        let mut color = match (paint, gradient(paint)) {
            (usvg::Paint::Color(c), _) => plain(*c, opacity),
            (_, Some(gradient)) => {
                let stops = gradient.stops().iter();
                let stops: Vec<Rgba> = stops
                    .map(|s| plain(s.color(), s.opacity().get() * opacity))
                    .collect();
                let dark = stops.iter().filter(|s| is_dark(**s)).count();
                if dark != 0 && dark != stops.len() {
                    return Err(unsupported(
                        "a gradient from dark to light",
                        "give the shape one flat colour",
                    ));
                }
                std::array::from_fn(|k| stops.iter().map(|s| s[k] / stops.len() as f32).sum())
            }
            _ => return Err(unsupported("a pattern", "give the shape one flat colour")),
        };
        if self.two_tone {
            let tone = if is_dark(color) { 0.0 } else { 1.0 };
            color = [tone, tone, tone, 1.0];
        }
        Ok(color)
    }
}

/// Refuses curves so large that flattening them would use up all memory; next to nothing of them is
/// visible.
fn check_reach(curve: &BezPath, to_profile: Affine) -> Result<()> {
    let b = (to_profile * curve.clone()).control_box();
    let reach = b.x0.abs().max(b.x1.abs()).max(b.y0.abs()).max(b.y1.abs());
    if reach <= Profile::EXTENT {
        return Ok(());
    }
    Err(content_fault(format!(
        "the drawing has a shape that reaches {reach:.0} times its height; {} is the most, crop it",
        Profile::EXTENT
    )))
}

/// Refuses strokes with more dashes than can be seen.
fn check_dashes(curve: &BezPath, stroke: &usvg::Stroke) -> Result<()> {
    const MOST: f64 = 1e5;
    let Some(dashes) = stroke.dasharray() else {
        return Ok(());
    };
    let period: f64 = dashes.iter().map(|&d| f64::from(d)).sum();
    let count = curve.perimeter(1.0) / period * dashes.len() as f64;
    if count <= MOST {
        return Ok(());
    }
    Err(content_fault(format!(
        "the drawing has a stroke of {count:.0} dashes; {MOST} are the most, make them longer"
    )))
}

/// A closed contour cut by the box `0 <= r <= radius`, `0 <= z <= 1` (Sutherland & Hodgman 1974).
/// Pieces of it may run along the box's border twice, there and back: they enclose nothing.
fn clip_to_box(mut points: Vec<DVec2>, radius: f64) -> Vec<DVec2> {
    type Inside = fn(DVec2, f64) -> f64;
    let sides: [Inside; 4] = [|p, _| p.x, |p, r| r - p.x, |p, _| p.y, |p, _| 1.0 - p.y];
    for depth in sides {
        if points.iter().all(|&p| depth(p, radius) >= 0.0) {
            continue;
        }
        let mut kept = Vec::with_capacity(points.len() + 4);
        let Some(&last) = points.last() else {
            return points;
        };
        let mut previous = last;
        for &p in &points {
            let (d0, d1) = (depth(previous, radius), depth(p, radius));
            if (d0 < 0.0) != (d1 < 0.0) {
                kept.push(previous + (p - previous) * (d0 / (d0 - d1)));
            }
            if d1 >= 0.0 {
                kept.push(p);
            }
            previous = p;
        }
        points = kept;
    }
    points
}

#[cfg(test)]
mod tests;
