//! Viewports: the page, nested `svg` elements, symbols and markers.

use crate::EXTENT;
use crate::element::attribute;
use crate::notes::{Fault, Notes, Result};
use crate::style::Style;
use crate::value::Length;
use kurbo::{Affine, Rect};
use roxmltree::Node;
use std::str::FromStr;
use svgtypes::{Align, AspectRatio, NumberListParser};

/// The `viewBox` of an element. One without area shows nothing.
pub(crate) fn view_box(node: Node, notes: &mut Notes) -> Option<Rect> {
    let text = attribute(node, "viewBox")?;
    let numbers: std::result::Result<Vec<f64>, _> = NumberListParser::from(text).collect();
    let valid = match numbers.as_deref() {
        Ok(&[x, y, w, h]) if w >= 0.0 && h >= 0.0 => Some(Rect::new(x, y, x + w, y + h)),
        _ => None,
    };
    if valid.is_none() {
        let how = ", which is not valid; it is ignored, as browsers do";
        notes.warn_at(node, &format!("viewBox=\"{text}\""), how);
    }
    valid
}

/// Maps the content of an element with this `viewBox` to a viewport of this size. Returns the size of
/// the content's own viewport, too.
pub(crate) fn fitted(node: Node, inner: Option<Rect>, size: (f64, f64)) -> (Affine, (f64, f64)) {
    let Some(inner) = inner else {
        return (Affine::IDENTITY, size);
    };
    let aspect = attribute(node, "preserveAspectRatio");
    let aspect = aspect
        .and_then(|a| AspectRatio::from_str(a).ok())
        .unwrap_or_default();
    let (sx, sy) = (size.0 / inner.width(), size.1 / inner.height());
    let to_corner = Affine::translate((-inner.x0, -inner.y0));
    let of_content = (inner.width(), inner.height());
    // Places are numbered from the upper left, row by row.
    let Some(place) = (aspect.align as u8).checked_sub(Align::XMinYMin as u8) else {
        return (Affine::scale_non_uniform(sx, sy) * to_corner, of_content);
    };
    let [x, y] = [place % 3, place / 3].map(|k| 0.5 * f64::from(k));
    let s = if aspect.slice { sx.max(sy) } else { sx.min(sy) };
    let free = (size.0 - s * inner.width(), size.1 - s * inner.height());
    let moved = Affine::translate((x * free.0, y * free.1));
    (moved * Affine::scale(s) * to_corner, of_content)
}

/// Width and height of the page in pixels.
pub(crate) fn page(style: &Style, inner: Option<Rect>) -> Result<(f64, f64)> {
    if inner.is_some_and(|i| i.area() <= 0.0) {
        return Err(Fault::new(
            "the drawing has a viewBox without area, which shows nothing; correct it",
        ));
    }
    let given = |name: &str, whole: Option<f64>| match style.geometry(name) {
        Some(Length::Px(v)) => Some(v),
        Some(Length::Part(part)) => whole.map(|w| part * w),
        None => None,
    };
    let width = given("width", inner.map(|i| i.width()));
    let height = given("height", inner.map(|i| i.height()));
    let size = match (width, height, inner) {
        (Some(w), Some(h), _) => (w, h),
        (Some(w), None, Some(i)) => (w, w * i.height() / i.width()),
        (None, Some(h), Some(i)) => (h * i.width() / i.height(), h),
        (None, None, Some(i)) => (i.width(), i.height()),
        (_, _, None) => {
            return Err(Fault::new(
                "the drawing gives no size; add viewBox, or width and height",
            ));
        }
    };
    let (width, height) = size;
    let most = EXTENT;
    if !(width > 0.0 && height > 0.0 && size.0.is_finite() && size.1.is_finite()) {
        return Err(Fault::new(format!(
            "the drawing has a page of {width} x {height}; give a positive width and height"
        )));
    }
    if width > most * height || height > most * width {
        return Err(Fault::new(format!(
            "the drawing has a page of {width} x {height}; one side is at most {most} times the other"
        )));
    }
    Ok(size)
}
