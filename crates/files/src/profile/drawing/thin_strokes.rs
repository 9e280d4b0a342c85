//! Thin strokes of a drawing beside its filled shapes.

use super::canvas::{Canvas, FLATNESS};
use super::paint::is_dark;
use crate::profile::seeming::marks::{Mark, Marks, SOLID, THIN};
use glam::DVec2;
use kurbo::{Affine, BezPath, ParamCurve as _, PathSeg};
use revmap::error::Result;
use revmap::profile::{Outline, Region};
use revmap_drawing::Node;
use std::cell::Cell;

/// Places along a piece of a stroke.
const SAMPLES: usize = 64;
/// Most pieces that are looked at.
const MOST_PIECES: usize = 4096;
/// Least length beside the solid, in heights and in widths of the stroke.
const BESIDE: f64 = 0.01;
const WIDTHS: f64 = 4.0;
/// A piece that leaves its chord by less is straight, object units.
const STRAIGHT: f64 = 1e-3;
/// Straight pieces shorter than this belong to a curve, object units.
const SHORT: f64 = 0.02;

/// A thin dark stroke in object units.
pub(super) struct ThinStroke {
    curve: BezPath,
    width: f64,
    has_dots: bool,
    line: u32,
}

/// A piece of a stroke, and places along it.
struct Piece<'a> {
    stroke: &'a ThinStroke,
    points: Vec<DVec2>,
    is_straight: bool,
}

impl Canvas {
    /// The dark strokes that are thin.
    pub fn thin_strokes(&self, nodes: &[Node]) -> Vec<ThinStroke> {
        let mut found = Vec::new();
        self.add_thin(nodes, self.page, &mut found);
        found
    }

    fn add_thin(&self, nodes: &[Node], to_profile: Affine, found: &mut Vec<ThinStroke>) {
        for node in nodes {
            match node {
                Node::Group(group) => {
                    self.add_thin(&group.children, to_profile * group.transform, found);
                }
                Node::Path(path) => {
                    let Some(band) = path.band.as_ref().filter(|_| is_dark(path.color)) else {
                        continue;
                    };
                    let width = self.width(band, to_profile);
                    let dashes = &band.style.dash_pattern;
                    if (self.min_stroke..THIN).contains(&width) {
                        found.push(ThinStroke {
                            curve: to_profile * &path.curve,
                            width,
                            has_dots: dashes.len() >= 4 && dashes[0] != dashes[2],
                            line: band.line,
                        });
                    }
                }
            }
        }
    }

    /// This canvas without thin strokes.
    pub fn without_thin(&self) -> Self {
        Self {
            min_stroke: THIN,
            cuts: Cell::new(false),
            ..*self
        }
    }

    /// Warnings about strokes that show beside the rest of the solid; `None` if there are none. `whole`
    /// and `rest` are dark with thin strokes and without.
    pub fn marks(
        &self,
        strokes: &[ThinStroke],
        whole: &Region,
        rest: &Region,
    ) -> Option<Vec<String>> {
        let [whole, rest] = [whole, rest].map(|region| region.outline(self.grid));
        let bounds = rest.bounds().filter(|_| rest.area() >= SOLID)?;
        // Finer ones are dropped with the slivers.
        let strokes = strokes.iter().filter(|s| s.width > 2.0 * FLATNESS);
        let pieces: Vec<Piece> = strokes.flat_map(pieces).take(MOST_PIECES).collect();
        // Half of a stroke along the axis is beyond it, so that places are right of the middle.
        let moved = |way: DVec2| {
            let of_piece = |piece: &Piece| {
                let by = way * piece.stroke.width;
                let points: Vec<DVec2> = piece.points.iter().map(|p| p + by).collect();
                points
            };
            pieces.iter().flat_map(of_piece).collect::<Vec<_>>()
        };
        let mut beside = inside(&whole, &moved(0.25 * DVec2::X));
        for way in [DVec2::ZERO, DVec2::X, DVec2::NEG_X, DVec2::Y, DVec2::NEG_Y] {
            let filled = inside(&rest, &moved(2.0 * way));
            let pairs = beside.iter_mut().zip(filled);
            pairs.for_each(|(beside, filled)| *beside &= !filled);
        }
        let (mut marks, mut widest) = (Vec::new(), 0.0f64);
        let mut curved: f64 = 0.0;
        for (k, piece) in pieces.iter().enumerate() {
            let own = &beside[k * SAMPLES..][..SAMPLES];
            let share = own.iter().filter(|b| **b).count() as f64 / SAMPLES as f64;
            let ends = [piece.points[0], piece.points[SAMPLES - 1]];
            let stroke = piece.stroke;
            let mut length = share * ends[0].distance(ends[1]);
            if !piece.is_straight {
                let is_next = k > 0 && std::ptr::eq(stroke, pieces[k - 1].stroke);
                curved = length + if is_next { curved } else { 0.0 };
                length = curved;
            }
            if length < BESIDE.max(WIDTHS * stroke.width) {
                continue;
            }
            widest = widest.max(stroke.width);
            marks.push(Mark {
                low: ends[0].min(ends[1]),
                high: ends[0].max(ends[1]),
                is_straight: piece.is_straight,
                has_dots: stroke.has_dots,
                line: Some(stroke.line),
            });
        }
        if marks.is_empty() {
            return None;
        }
        let marks = Marks {
            all: marks,
            solid: [
                DVec2::new(bounds.r_min, bounds.z_min),
                DVec2::new(bounds.r_max, bounds.z_max),
            ],
            axis: 0.0,
            slack: 2.0 * widest,
        };
        // One digit more than the widest.
        let digit = 10f64.powi(widest.log10().floor() as i32);
        let most = ((widest / digit).floor() + 1.0) * digit;
        let remedy = format!("remove it, or set profile_min_stroke = {most:.6}");
        Some(marks.warnings("drawing", remedy.trim_end_matches('0')))
    }

    /// The dark region of nodes.
    pub fn dark_region(&self, nodes: &[Node]) -> Result<Region> {
        self.tile().dark(&self.paints(nodes, self.page)?)
    }
}

/// The segments of a stroke's curve.
fn pieces(stroke: &ThinStroke) -> impl Iterator<Item = Piece<'_>> {
    stroke.curve.segments().map(move |segment: PathSeg| {
        let at = |k: usize| {
            let p = segment.eval(k as f64 / (SAMPLES - 1) as f64);
            DVec2::new(p.x, p.y)
        };
        let points: Vec<DVec2> = (0..SAMPLES).map(at).collect();
        let chord = points[SAMPLES - 1] - points[0];
        let along = chord.normalize_or_zero();
        let off = points.iter().map(|p| along.perp_dot(*p - points[0]).abs());
        Piece {
            stroke,
            is_straight: chord.length() >= SHORT && off.fold(0.0, f64::max) < STRAIGHT,
            points,
        }
    })
}

/// Whether each point is inside of an outline.
fn inside(outline: &Outline, points: &[DVec2]) -> Vec<bool> {
    let rows = outline.crossings(points.iter().map(|p| p.y));
    let is_in = |(row, p): (Vec<f64>, &DVec2)| row.iter().filter(|r| **r < p.x).count() % 2 == 1;
    rows.into_iter().zip(points).map(is_in).collect()
}
