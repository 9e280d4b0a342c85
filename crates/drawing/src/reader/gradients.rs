//! Paints and gradients as colours.

use crate::element::{attribute, href};
use crate::notes::{Fault, Result, misled, unsupported};
use crate::reader::Reader;
use crate::style::Style;
use crate::value::color::{Rgba, luminance, premultiplied};
use crate::value::paint::Paint;
use kurbo::Rect;
use roxmltree::Node;

/// References from gradient to gradient.
const MOST_LINKS: usize = 32;
/// The remedy for paints that are no colour.
const FLAT: &str = "give the shape one flat colour";

/// A colour, or the darkest and the lightest of a gradient.
type Shade = (Rgba, Option<Rgba>);

impl<'a> Reader<'a> {
    /// The colour of a paint, premultiplied, with the lightest one of a gradient.
    pub fn solid(
        &mut self,
        paint: &Paint,
        opacity: f32,
        style: &Style,
        bounds: Rect,
        node: Node,
    ) -> Result<Option<Shade>> {
        if opacity <= 0.0 {
            return Ok(None);
        }
        let (target, fallback) = match style.resolved(paint) {
            Paint::None | Paint::Current | Paint::Context(_) => return Ok(None),
            Paint::Color(color) => return Ok(Some((premultiplied(*color, opacity), None))),
            Paint::Fault(text) => return Err(Fault::new(text.to_string())),
            Paint::Server(target, fallback) => (target, fallback),
        };
        let found = target.as_ref().ok().and_then(|id| self.by_id(id));
        match (found, found.map(|n| n.tag_name().name())) {
            (_, Some("pattern")) => return Err(unsupported(node, "a pattern", FLAT)),
            (Some(gradient), Some("linearGradient" | "radialGradient")) => {
                if let Some(color) = self.gradient(gradient, opacity, bounds)? {
                    return Ok(Some(color));
                }
            }
            _ if fallback.is_none() => {
                let (Ok(id) | Err(id)) = target;
                let how = format!("which is not in it; {FLAT}");
                return Err(misled(node, &format!("a paint \"{id}\""), &how));
            }
            _ => {}
        }
        match fallback {
            Some(paint) => self.solid(paint, opacity, style, bounds, node),
            None => Ok(None),
        }
    }

    /// The colours of a gradient's stops; `None` for a gradient that paints nothing.
    fn gradient(
        &mut self,
        gradient: Node<'a, 'a>,
        opacity: f32,
        bounds: Rect,
    ) -> Result<Option<Shade>> {
        let (mut stops, mut units, mut at) = (Vec::new(), None, Some(gradient));
        for _ in 0..MOST_LINKS {
            let Some(n) = at else { break };
            let is_stop = |n: &Node| n.is_element() && n.tag_name().name() == "stop";
            if stops.is_empty() {
                stops = n.children().filter(is_stop).collect();
            }
            units = units.or_else(|| attribute(n, "gradientUnits"));
            let id = href(n).and_then(|h| h.strip_prefix('#'));
            at = id.and_then(|id| self.by_id(id));
        }
        let flat = bounds.width() <= 0.0 || bounds.height() <= 0.0;
        if flat && units != Some("userSpaceOnUse") {
            return Ok(None);
        }
        let mut colors = Vec::new();
        for stop in stops {
            let style = self.style_of(stop)?;
            style.own.check()?;
            let alpha = style.own.stop_opacity * opacity;
            match style.resolved(&style.own.stop_color) {
                Paint::Color(color) => colors.push(premultiplied(*color, alpha)),
                Paint::Fault(text) => return Err(Fault::new(text.to_string())),
                _ => {}
            }
        }
        Ok(extremes(&colors))
    }
}

/// Bounds of the colours of a gradient's stops: the darkest and, if that makes a difference, the
/// lightest. Over every ground, each stop is between the two.
fn extremes(stops: &[Rgba]) -> Option<(Rgba, Option<Rgba>)> {
    let count = stops.len() as f32;
    let mean = std::array::from_fn(|k| stops.iter().map(|c| c[k] / count).sum());
    let over_black = |c: &Rgba| luminance([c[0], c[1], c[2]]);
    let over_white = |c: &Rgba| over_black(c) + 1.0 - c[3];
    let least = |value: &dyn Fn(&Rgba) -> f32| stops.iter().map(value).reduce(f32::min);
    let most = |value: &dyn Fn(&Rgba) -> f32| stops.iter().map(value).reduce(f32::max);
    let grey = |black: f32, white: f32| [black, black, black, 1.0 - (white - black)];
    let (low, low_white) = (least(&over_black)?, least(&over_white)?);
    let (high, high_white) = (most(&over_black)?, most(&over_white)?);
    if high - low < 1e-3 && high_white - low_white < 1e-3 {
        return Some((mean, None));
    }
    let opaque = stops.iter().all(|c| c[3] >= 1.0);
    if opaque && (high < 0.5 || low >= 0.5) {
        return Some((mean, Some(grey(high, high_white))));
    }
    Some((grey(low, low_white), Some(grey(high, high_white))))
}
