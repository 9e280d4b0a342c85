//! The drawing area: nodes of a drawing as regions of the half-plane.

use super::paint::{Paint, Rgba, is_dark, over_white};
use super::tile::{Tile, overlap};
use crate::content_fault;
use crate::profile::advice::PAINT_DARK;
use crate::profile::seeming::gaps;
use glam::DVec2;
use kurbo::{Affine, BezPath, Cap, Ellipse, PathEl, Shape, Size, StrokeOpts, Vec2};
use revmap::error::Result;
use revmap::profile::{FillRule, Grid, Outline, Profile, Region};
use revmap_drawing::{Band, Clip, Group, Node, Path, luminance};
use std::cell::Cell;

/// Largest distance between a curve and its chords, object units.
pub(crate) const FLATNESS: f64 = 1e-5;

/// Most dashes of a stroke, and most pairs of round or square ones that overlap.
const MOST_DASHES: f64 = 2e4;
const MOST_OVERLAPS: f64 = 2e5;

/// Paint is cut by an edge of the page if it reaches this far to both sides, object units.
const CUT: f64 = 5e-3;

/// Paint over more than this part of the page is its ground.
const GROUND: f64 = 0.98;

/// The drawing area: the viewport or its right half, on the integer grid.
pub(super) struct Canvas {
    pub low: DVec2,
    pub high: DVec2,
    pub grid: Grid,
    /// All paint is opaque, so dark and light are the only two colours needed.
    pub two_tone: bool,
    /// All paint that is not white counts as dark.
    pub tinted: bool,
    /// Strokes thinner than this are left out, with their markers; object units.
    pub min_stroke: f64,
    /// Maps the page to `(r, z)`.
    pub page: Affine,
    /// Some geometry was beyond the drawing area.
    pub cuts: Cell<bool>,
}

impl Canvas {
    pub fn tile(&self) -> Tile {
        Tile {
            grid: self.grid,
            low: self.grid.rounded(self.low),
            high: self.grid.rounded(self.high),
        }
    }

    /// The dark outline of nodes.
    pub fn dark(&self, nodes: &[Node]) -> Result<Outline> {
        Ok(self.dark_region(nodes)?.outline(self.grid))
    }

    /// The drawing area with its surroundings.
    pub fn beyond(&self) -> Self {
        let margin = (self.high - self.low).max_element();
        let (low, high) = (self.low - margin, self.high + margin);
        Self {
            low,
            high,
            grid: Grid::for_extent(high.max(-low).max_element()),
            cuts: Cell::new(false),
            ..*self
        }
    }

    /// Returns true if the box of some points has a part in the drawing area.
    pub fn shows(&self, points: &[DVec2]) -> bool {
        let low = points.iter().copied().reduce(DVec2::min);
        let high = points.iter().copied().reduce(DVec2::max);
        overlap(low.zip(high).map(Into::into), Some([self.low, self.high]))
    }

    /// The edges that dark paint of an outline crosses.
    pub fn cut_edges(&self, outline: &Outline) -> Vec<&'static str> {
        let turned = gaps::turned(outline);
        let (low, high) = (self.low, self.high);
        let edges = [
            ("top", outline, high.y, CUT, [low.x, high.x]),
            ("bottom", outline, low.y, -CUT, [low.x, high.x]),
            ("right", &turned, high.x, CUT, [low.y, high.y]),
        ];
        let cut = edges
            .into_iter()
            .filter(|&(_, outline, edge, way, [from, to])| {
                let lines = outline.crossings([edge - way, edge + way].into_iter());
                let [within, beyond] = [0, 1].map(|k| lines[k].chunks_exact(2));
                let mut pairs = within.flat_map(|a| beyond.clone().map(move |b| (a, b)));
                pairs.any(|(a, b)| a[0].max(b[0]).max(from) < a[1].min(b[1]).min(to))
            });
        cut.map(|(edge, ..)| edge).collect()
    }

    /// Names the darkest of the light paint, if all paint covers more than `least` times the area of
    /// the dark, and is no ground.
    pub fn pale(&self, nodes: &[Node], dark: f64, least: f64) -> Option<String> {
        let (color, kind) = darkest_pale(nodes)?;
        let tinted = Self {
            tinted: true,
            two_tone: true,
            cuts: Cell::new(false),
            ..*self
        };
        let all = tinted.dark(nodes).ok()?.area();
        let [r, g, b, _] = over_white(color).map(|v| (255.0 * v).round() as u8);
        let page = self.high - self.low;
        let is_ground = dark > 0.0 && all > GROUND * page.x * page.y;
        (all > least * dark && !is_ground).then(|| {
            format!(
                "the darkest {kind} is #{r:02x}{g:02x}{b:02x}, lighter than one half{PAINT_DARK}"
            )
        })
    }

    /// What nodes paint. `to_profile` maps their coordinates to `(r, z)`.
    pub fn paints(&self, nodes: &[Node], to_profile: Affine) -> Result<Vec<Paint>> {
        let mut paints = Vec::new();
        let mut is_thin = false;
        for node in nodes {
            match node {
                Node::Group(group) if group.is_marker && is_thin => {}
                Node::Group(group) => self.group(group, to_profile, &mut paints)?,
                Node::Path(path) => {
                    let width = path.band.as_ref().map(|b| self.width(b, to_profile));
                    is_thin = width.is_some_and(|width| width < self.min_stroke);
                    if is_thin {
                        continue;
                    }
                    let region = match &path.band {
                        None => {
                            check_reach(&path.curve, to_profile)?;
                            self.enclosed(&path.curve, to_profile, FLATNESS, rule(path.rule))
                        }
                        Some(band) => self.band(path, band, to_profile)?,
                    };
                    let lightest = path.lightest.map(|(color, line)| (self.tone(color), line));
                    let lightest = lightest.filter(|(color, _)| *color != self.tone(path.color));
                    paints.push(Paint::Region(Some(region), self.tone(path.color), lightest));
                }
            }
        }
        Ok(paints)
    }

    fn group(&self, group: &Group, to_parent: Affine, paints: &mut Vec<Paint>) -> Result<()> {
        let to_profile = to_parent * group.transform;
        let mut own = self.paints(&group.children, to_profile)?;
        if group.opacity >= 1.0 && group.clip.is_none() {
            paints.append(&mut own);
            return Ok(());
        }
        let clip = match &group.clip {
            Some(clip) => Some(self.clip_region(clip, to_profile)?),
            None => None,
        };
        paints.push(Paint::Group {
            opacity: group.opacity,
            clip,
            paints: own,
        });
        Ok(())
    }

    /// The width of a stroke, object units.
    pub fn width(&self, band: &Band, to_profile: Affine) -> f64 {
        let to_profile = if band.on_page { self.page } else { to_profile };
        band.style.width * magnification(to_profile)
    }

    /// The region that a stroke covers.
    fn band(&self, path: &Path, band: &Band, to_profile: Affine) -> Result<Region> {
        let (mut curve, mut to_profile) = (path.curve.clone(), to_profile);
        if band.on_page {
            curve.apply_affine(self.page.inverse() * to_profile);
            to_profile = self.page;
        }
        check_reach(&curve, to_profile)?;
        check_dashes(&curve, band)?;
        let mut style = band.style.clone();
        // Half of the tolerance is for the stroke's outline, half for its flattening.
        let tolerance = 0.5 * FLATNESS / magnification(to_profile);
        let (lines, dots) = with_dots(&curve, &mut style);
        let options = StrokeOpts::default();
        let mut shape = kurbo::stroke(lines.iter(), &style, &options, tolerance);
        style.dash_pattern.clear();
        shape.extend(kurbo::stroke(dots.iter(), &style, &options, tolerance));
        Ok(self.enclosed(&shape, to_profile, 0.5 * FLATNESS, FillRule::NonZero))
    }

    /// The union of a clip's shapes, cut by its own clip.
    fn clip_region(&self, clip: &Clip, to_parent: Affine) -> Result<Region> {
        let to_profile = to_parent * clip.transform;
        let mut regions = Vec::new();
        for shape in &clip.shapes {
            check_reach(&shape.curve, to_profile)?;
            let mut region = self.enclosed(&shape.curve, to_profile, FLATNESS, rule(shape.rule));
            if let Some(clip) = &shape.clip {
                region = region.intersection(&self.clip_region(clip, to_profile)?);
            }
            regions.push(region);
        }
        let region = Region::merged(regions);
        match &clip.within {
            Some(outer) => Ok(region.intersection(&self.clip_region(outer, to_parent)?)),
            None => Ok(region),
        }
    }

    /// The region of the drawing area that a path encloses.
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
            let inside = self.clip_to_box(std::mem::take(points));
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

    /// The colour, or black or white if only its darkness counts.
    fn tone(&self, color: Rgba) -> Rgba {
        let is_dark = match self.tinted {
            true => color[3] > 0.0 && is_tinted(color),
            false => is_dark(color),
        };
        match (self.two_tone, is_dark) {
            (false, _) => color,
            (true, true) => [0.0, 0.0, 0.0, 1.0],
            (true, false) => [1.0; 4],
        }
    }

    /// A closed contour cut by the drawing area (Sutherland & Hodgman 1974). Pieces of it may run
    /// along the border twice, there and back: they enclose nothing.
    fn clip_to_box(&self, mut points: Vec<DVec2>) -> Vec<DVec2> {
        for side in 0..4 {
            let depth = |p: DVec2| match side {
                0 => p.x - self.low.x,
                1 => self.high.x - p.x,
                2 => p.y - self.low.y,
                _ => self.high.y - p.y,
            };
            if points.iter().all(|&p| depth(p) >= 0.0) {
                continue;
            }
            self.cuts.set(true);
            let mut kept = Vec::with_capacity(points.len() + 4);
            let Some(&last) = points.last() else {
                return points;
            };
            let mut previous = last;
            for &p in &points {
                let (d0, d1) = (depth(previous), depth(p));
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
}

fn rule(of_drawing: revmap_drawing::FillRule) -> FillRule {
    match of_drawing {
        revmap_drawing::FillRule::NonZero => FillRule::NonZero,
        revmap_drawing::FillRule::EvenOdd => FillRule::EvenOdd,
    }
}

/// Returns true for a colour that is not white over white.
fn is_tinted(color: Rgba) -> bool {
    let [r, g, b, _] = over_white(color);
    r.min(g).min(b) < 0.97
}

/// The darkest colour that is light and not white, and what it paints.
fn darkest_pale(nodes: &[Node]) -> Option<(Rgba, &'static str)> {
    let of = |node: &Node| match node {
        Node::Group(group) => darkest_pale(&group.children),
        Node::Path(path) => {
            let kind = if path.band.is_some() {
                "stroke"
            } else {
                "fill"
            };
            let is_pale = !is_dark(path.color) && is_tinted(path.color);
            is_pale.then_some((path.color, kind))
        }
    };
    let grey = |(color, _): &(Rgba, _)| {
        let [r, g, b, _] = over_white(*color);
        luminance([r, g, b])
    };
    let found = nodes.iter().filter_map(of);
    found.min_by(|a, b| grey(a).total_cmp(&grey(b)))
}

/// Dots are lines of this part of the stroke's width.
const DOT: f64 = 1e-5;

/// Splits a path into lines and dots, which are subpaths of no length. With round and square caps
/// they show, and so do dashes of no length. Both become short lines.
fn with_dots(curve: &BezPath, style: &mut kurbo::Stroke) -> (BezPath, BezPath) {
    if style.start_cap == Cap::Butt {
        return (curve.clone(), BezPath::new());
    }
    let length = DOT * style.width;
    let count = style.dash_pattern.len();
    for k in (0..count).step_by(2) {
        if style.dash_pattern[k] < length {
            style.dash_pattern[k] = length;
            style.dash_pattern[k + 1] = (style.dash_pattern[k + 1] - length).max(0.0);
        }
    }
    let (mut lines, mut dots) = (BezPath::new(), BezPath::new());
    for part in curve.subpaths() {
        let part = BezPath::from_vec(part.to_vec());
        let (place, half) = (part.control_box(), Vec2::new(0.5 * length, 0.0));
        if part.elements().len() > 1 && place.size() == Size::ZERO {
            dots.move_to(place.center() - half);
            dots.line_to(place.center() + half);
        } else {
            lines.extend(part);
        }
    }
    (lines, dots)
}

/// Largest factor by which lengths grow.
fn magnification(t: Affine) -> f64 {
    Ellipse::from_affine(t).radii().x.max(f64::MIN_POSITIVE)
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
fn check_dashes(curve: &BezPath, Band { style, line, .. }: &Band) -> Result<()> {
    let dashes = &style.dash_pattern;
    if dashes.is_empty() {
        return Ok(());
    }
    let period = dashes.iter().sum::<f64>() / (0.5 * dashes.len() as f64);
    let count = curve.perimeter(1e-3 * style.width.max(period)) / period;
    let overlaps = match style.start_cap {
        Cap::Butt => 0.0,
        _ => count * (style.width / period).floor(),
    };
    if count <= MOST_DASHES && overlaps <= MOST_OVERLAPS {
        return Ok(());
    }
    Err(content_fault(format!(
        "the drawing has a stroke of {count:.0} dashes (line {line}), which are too many; make them longer"
    )))
}
