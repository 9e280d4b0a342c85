//! Markers: the content that is repeated at the corners of a line.

use crate::element::attribute;
use crate::notes::{Result, misled};
use crate::reader::shapes::Curve;
use crate::reader::viewport::{fitted, view_box};
use crate::reader::{Place, Reader, Shown};
use crate::style::Style;
use crate::tree::{Clip, Group, Node as Drawn};
use crate::value::{length, radians, split_number};
use kurbo::{Affine, PathEl, Point, Rect, Vec2};
use roxmltree::Node;

/// A corner of a path with the directions of the line before and after it.
struct Corner {
    at: Point,
    before: Option<Vec2>,
    after: Option<Vec2>,
}

impl Corner {
    /// The direction of a marker here, radians.
    fn angle(&self) -> f64 {
        let unit = |v: Option<Vec2>| v.map(Vec2::normalize);
        match (unit(self.before), unit(self.after)) {
            (Some(a), Some(b)) if (a + b).hypot() > 1e-9 => (a + b).atan2(),
            (Some(a), _) => a.atan2(),
            (None, Some(b)) => b.atan2(),
            (None, None) => 0.0,
        }
    }
}

impl<'a> Reader<'a> {
    /// Adds the markers of a shape. `width` is that of its stroke.
    pub(crate) fn markers(
        &mut self,
        node: Node<'a, 'a>,
        style: &Style,
        place: Place,
        curve: &Curve,
        width: f64,
    ) -> Shown {
        let mut out = Vec::new();
        let marked = matches!(
            node.tag_name().name(),
            "path" | "line" | "polyline" | "polygon"
        );
        if !marked || style.markers.iter().all(Option::is_none) {
            return Ok(out);
        }
        let corners = corners(curve);
        let last = corners.len().saturating_sub(1);
        for (k, target) in style.markers.iter().enumerate() {
            let Some(target) = target else { continue };
            // Browsers ignore one that is missing.
            let Some(marker) = self.found(target, "marker") else {
                let (Ok(id) | Err(id)) = target;
                let how = ", which is not in it and is left out";
                self.notes.warn_at(node, &format!("a marker \"{id}\""), how);
                continue;
            };
            for (i, corner) in corners.iter().enumerate() {
                let here = match k {
                    0 => i == 0,
                    1 => i > 0 && i < last,
                    _ => i == last,
                };
                if here {
                    let drawn = self.marker_at(marker, corner, k == 0, style, place, width)?;
                    out.extend(drawn.map(Drawn::Group));
                }
            }
        }
        Ok(out)
    }

    fn marker_at(
        &mut self,
        marker: Node<'a, 'a>,
        corner: &Corner,
        is_start: bool,
        of_shape: &Style,
        place: Place,
        width: f64,
    ) -> Result<Option<Group>> {
        if self.open.contains(&marker.id()) {
            let what = "a marker that contains itself";
            return Err(misled(marker, what, "without an end; remove the inner one"));
        }
        let mut style = self.style_of(marker)?;
        style.context = of_shape.as_context();
        let size = |name: &str, whole: f64, usual: f64| {
            let text = attribute(marker, name).map(str::trim);
            let read = text.map(|t| length(t, style.fonts, true));
            read.and_then(|read| read.ok())
                .map_or(usual, |l| l.of(whole))
        };
        let own = (
            size("markerWidth", place.viewport.0, 3.0),
            size("markerHeight", place.viewport.1, 3.0),
        );
        let inner = view_box(marker, &mut self.notes);
        if own.0 <= 0.0
            || own.1 <= 0.0
            || inner.is_some_and(|i| i.area() <= 0.0)
            || (width <= 0.0 && attribute(marker, "markerUnits").is_none())
        {
            return Ok(None);
        }
        let (fit, whole) = fitted(marker, inner, own);
        let reference = fit * Point::new(size("refX", whole.0, 0.0), size("refY", whole.1, 0.0));
        let angle = match attribute(marker, "orient").map(str::trim) {
            Some("auto") => corner.angle(),
            Some("auto-start-reverse") if is_start => corner.angle() + std::f64::consts::PI,
            Some("auto-start-reverse") => corner.angle(),
            text => match text.and_then(split_number) {
                Some((v, "")) => v.to_radians(),
                Some((v, unit)) => radians(v, unit).unwrap_or(0.0),
                None => 0.0,
            },
        };
        let scale = match attribute(marker, "markerUnits") {
            Some("userSpaceOnUse") => 1.0,
            _ => width,
        };
        let transform = Affine::translate(corner.at.to_vec2())
            * Affine::rotate(angle)
            * Affine::scale(scale)
            * Affine::translate(-reference.to_vec2());
        self.open.push(marker.id());
        let within = Place {
            viewport: whole,
            ..place.deeper()
        };
        let content = self.children(marker, &style, within)?;
        self.open.pop();
        if content.is_empty() {
            return Ok(None);
        }
        let clip = (!style.own.overflow).then(|| Clip::to_rect(Rect::new(0.0, 0.0, own.0, own.1)));
        style.own.check()?;
        Ok(Some(Group {
            opacity: style.own.opacity,
            clip,
            is_marker: true,
            ..Group::moved(transform, vec![Drawn::Group(Group::moved(fit, content))])
        }))
    }
}

/// The corners of a curve in their order.
fn corners(curve: &Curve) -> Vec<Corner> {
    let mut corners: Vec<Corner> = Vec::new();
    let (mut at, mut first) = (Point::ZERO, 0);
    for (i, element) in curve.path.elements().iter().enumerate() {
        let inside = curve.within_arcs.binary_search(&i).is_ok();
        let start = corners.get(first).map(|c| c.at);
        let points: &[Point] = match *element {
            PathEl::MoveTo(p) => {
                first = corners.len();
                corners.push(Corner {
                    at: p,
                    before: None,
                    after: None,
                });
                at = p;
                continue;
            }
            PathEl::LineTo(p) => &[p],
            PathEl::QuadTo(c, p) => &[c, p],
            PathEl::CurveTo(c, d, p) => &[c, d, p],
            PathEl::ClosePath => start.as_slice(),
        };
        let Some((&to, controls)) = points.split_last() else {
            continue;
        };
        let is_long = |v: &Vec2| v.hypot() > 0.0;
        if let Some(previous) = corners.last_mut()
            && previous.after.is_none()
        {
            previous.after = points.iter().map(|p| *p - at).find(is_long);
        }
        let backwards = controls.iter().rev().copied().chain([at]);
        let before = backwards.map(|p| to - p).find(is_long);
        at = to;
        if inside {
            continue;
        }
        corners.push(Corner {
            at: to,
            before,
            after: None,
        });
        if *element == PathEl::ClosePath {
            let last = corners.len() - 1;
            // Both ends of a closed line have the direction of the corner there. A closing line of
            // no length has the direction of the segment before it.
            if corners[last].before.is_none() && last > first {
                corners[last].before = corners[last - 1].before;
            }
            let (before, after) = (corners[last].before, corners[first].after);
            corners[first].before = before;
            corners[last].after = after;
        }
    }
    corners
}
