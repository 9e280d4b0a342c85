//! Strokes: width, dashes, caps and joins.

use crate::EXTENT;
use crate::element::attribute;
use crate::notes::{Result, unsupported};
use crate::reader::Place;
use crate::reader::shapes::Curve;
use crate::style::Style;
use crate::tree::{Band, FillRule, Path};
use kurbo::{BezPath, Cap, Rect, Shape, Stroke, Vec2};
use roxmltree::Node;

/// Gaps between round or square dashes of at most this part of the width are closed.
const CLOSED_GAP: f64 = 2.5e-3;

/// The path that an element's stroke covers, without its colour. `line`: of the element.
pub(crate) fn stroked(
    (node, line): (Node, u32),
    style: &Style,
    curve: &Curve,
    width: f64,
    place: Place,
) -> Result<Path> {
    let diagonal = place.diagonal();
    if width > EXTENT * diagonal {
        let what = format!("a stroke {width} wide");
        return Err(unsupported(node, &what, "draw a rectangle instead"));
    }
    let dashes = dashes(node, style, curve, width, diagonal);
    let bounds = curve.path.bounding_box();
    let is_round = matches!(node.tag_name().name(), "circle" | "ellipse");
    let is_full = width >= bounds.width().min(bounds.height());
    let on_page = style.own.vector_effect;
    if is_round && is_full && dashes.1.is_empty() && !on_page {
        // The inner border would be turned inside out.
        let border = outer_border(bounds, 0.5 * width);
        return Ok(Path::plain(border, FillRule::NonZero));
    }
    let stroke = Stroke::new(width)
        .with_miter_limit(style.miter_limit)
        .with_caps(style.cap)
        .with_join(style.join)
        .with_dashes(dashes.0, dashes.1);
    Ok(Path {
        band: Some(Band {
            style: stroke,
            on_page,
            line,
        }),
        ..Path::plain(curve.path.clone(), FillRule::NonZero)
    })
}

/// The curve at this distance outside of the ellipse in a box.
fn outer_border(bounds: Rect, distance: f64) -> BezPath {
    const CORNERS: u32 = 2048;
    let (rx, ry) = (0.5 * bounds.width(), 0.5 * bounds.height());
    let mut border = BezPath::new();
    for k in 0..CORNERS {
        let (sin, cos) = (std::f64::consts::TAU * f64::from(k) / f64::from(CORNERS)).sin_cos();
        let out = Vec2::new(ry * cos, rx * sin).normalize() * distance;
        let p = bounds.center() + Vec2::new(rx * cos, ry * sin) + out;
        match k {
            0 => border.move_to(p),
            _ => border.line_to(p),
        }
    }
    border.close_path();
    border
}

/// The offset and the lengths of dashes and gaps.
fn dashes(node: Node, style: &Style, curve: &Curve, width: f64, diagonal: f64) -> (f64, Vec<f64>) {
    let mut dashes: Vec<f64> = style.dashes.iter().map(|d| d.of(diagonal)).collect();
    let mut offset = style.dash_offset.of(diagonal);
    if dashes.iter().sum::<f64>() <= 0.0 {
        dashes.clear();
    }
    if dashes.len() % 2 == 1 {
        dashes.extend_from_within(..);
    }
    let stated = attribute(node, "pathLength").and_then(|t| t.trim().parse::<f64>().ok());
    if let Some(stated) = stated.filter(|v| *v > 0.0 && !dashes.is_empty()) {
        let factor = curve.path.perimeter(1e-3 * width) / stated;
        dashes.iter_mut().for_each(|d| *d *= factor);
        offset *= factor;
    }
    let mut gaps = dashes.iter().skip(1).step_by(2);
    if style.cap != Cap::Butt && gaps.all(|gap| *gap <= CLOSED_GAP * width) {
        dashes.clear();
    }
    (offset, dashes)
}
