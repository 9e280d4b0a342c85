//! Converts drawings from the SVG reader's types to those of this crate.

use crate::content_fault;
use kurbo::{Affine, BezPath, Cap, Join, PathEl, Point, Stroke};
use revmap::error::{Error, Result};
use revmap::profile::FillRule;
use usvg::roxmltree;
use usvg::tiny_skia_path::PathSegment;

/// Reads the drawing, and refuses by name elements that the reader would drop silently.
pub(super) fn parse(bytes: &[u8]) -> Result<usvg::Tree> {
    let damaged = |e: &dyn std::fmt::Display| {
        let text = e.to_string().replace('\n', " ");
        content_fault(format!(
            "the drawing is damaged ({text}); save it again as plain SVG"
        ))
    };
    let unpacked;
    let bytes = if bytes.starts_with(&[0x1f, 0x8b]) {
        unpacked = usvg::decompress_svgz(bytes).map_err(|e| damaged(&e))?;
        &unpacked
    } else {
        bytes
    };
    let text = std::str::from_utf8(bytes).map_err(|e| damaged(&e))?;
    let options = roxmltree::ParsingOptions {
        allow_dtd: true,
        ..Default::default()
    };
    let document =
        roxmltree::Document::parse_with_options(text, options).map_err(|e| damaged(&e))?;
    for node in document.descendants().filter(roxmltree::Node::is_element) {
        let name = node.tag_name().name();
        let remedy = match name {
            "text" => "convert it to paths",
            "image" => "trace it to paths",
            _ => continue,
        };
        let hidden = |n: &roxmltree::Node| {
            matches!(n.tag_name().name(), "defs" | "metadata")
                || n.attribute("display") == Some("none")
                || n.attribute("style")
                    .is_some_and(|s| s.replace(' ', "").contains("display:none"))
        };
        if !node.ancestors().any(|n| hidden(&n)) {
            return Err(unsupported(&format!("<{name}>"), remedy));
        }
    }
    usvg::Tree::from_xmltree(&document, &usvg::Options::default()).map_err(|e| damaged(&e))
}

/// The refusal of something that has no outline.
pub(super) fn unsupported(what: &str, remedy: &str) -> Error {
    content_fault(format!(
        "the drawing uses {what}, which has no outline here; {remedy}"
    ))
}

/// Returns true if anything in the tree is translucent.
pub(super) fn has_translucency(group: &usvg::Group) -> bool {
    let paint = |opacity: f32, paint: &usvg::Paint| {
        opacity < 1.0
            || gradient(paint).is_some_and(|g| g.stops().iter().any(|s| s.opacity().get() < 1.0))
    };
    group.opacity().get() < 1.0
        || group.children().iter().any(|node| match node {
            usvg::Node::Group(g) => has_translucency(g),
            usvg::Node::Path(p) => {
                p.fill()
                    .is_some_and(|f| paint(f.opacity().get(), f.paint()))
                    || p.stroke()
                        .is_some_and(|s| paint(s.opacity().get(), s.paint()))
            }
            _ => false,
        })
}

/// A paint's gradient, if it is one.
pub(super) fn gradient(paint: &usvg::Paint) -> Option<&usvg::BaseGradient> {
    match paint {
        usvg::Paint::LinearGradient(g) => Some(g),
        usvg::Paint::RadialGradient(g) => Some(g),
        usvg::Paint::Color(_) | usvg::Paint::Pattern(_) => None,
    }
}

/// A transform in 64 bits.
pub(super) fn affine(t: usvg::Transform) -> Affine {
    Affine::new([t.sx, t.ky, t.kx, t.sy, t.tx, t.ty].map(f64::from))
}

/// Largest factor by which lengths grow.
pub(super) fn magnification(t: Affine) -> f64 {
    let [a, b, c, d, ..] = t.as_coeffs();
    let (sum, det) = (a * a + b * b + c * c + d * d, a * d - b * c);
    (0.5 * (sum + (sum * sum - 4.0 * det * det).max(0.0).sqrt()))
        .sqrt()
        .max(f64::MIN_POSITIVE)
}

/// A fill rule.
pub(super) fn rule(rule: usvg::FillRule) -> FillRule {
    match rule {
        usvg::FillRule::NonZero => FillRule::NonZero,
        usvg::FillRule::EvenOdd => FillRule::EvenOdd,
    }
}

/// A path in 64 bits.
pub(super) fn curve(path: &usvg::tiny_skia_path::Path) -> BezPath {
    let point = |p: usvg::tiny_skia_path::Point| Point::new(f64::from(p.x), f64::from(p.y));
    path.segments()
        .map(|segment| match segment {
            PathSegment::MoveTo(p) => PathEl::MoveTo(point(p)),
            PathSegment::LineTo(p) => PathEl::LineTo(point(p)),
            PathSegment::QuadTo(p, q) => PathEl::QuadTo(point(p), point(q)),
            PathSegment::CubicTo(p, q, r) => PathEl::CurveTo(point(p), point(q), point(r)),
            PathSegment::Close => PathEl::ClosePath,
        })
        .collect()
}

/// A stroke's width, caps, joins and dashes.
pub(super) fn stroke_style(stroke: &usvg::Stroke) -> Stroke {
    let style = Stroke::new(f64::from(stroke.width().get()))
        .with_miter_limit(f64::from(stroke.miterlimit().get()))
        .with_caps(match stroke.linecap() {
            usvg::LineCap::Butt => Cap::Butt,
            usvg::LineCap::Round => Cap::Round,
            usvg::LineCap::Square => Cap::Square,
        })
        .with_join(match stroke.linejoin() {
            usvg::LineJoin::Miter | usvg::LineJoin::MiterClip => Join::Miter,
            usvg::LineJoin::Round => Join::Round,
            usvg::LineJoin::Bevel => Join::Bevel,
        });
    match stroke.dasharray() {
        Some(dashes) => {
            let dashes: Vec<f64> = dashes.iter().map(|&d| f64::from(d)).collect();
            style.with_dashes(f64::from(stroke.dashoffset()), dashes)
        }
        None => style,
    }
}
