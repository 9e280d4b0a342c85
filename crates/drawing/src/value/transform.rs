//! Transforms of attributes (`rotate(90 5 5)`) and of CSS (`rotate(90deg)`).

use crate::value::Unusable::{Unread, Wrong};
use crate::value::{Fonts, NUMBER, Value, factor, length, list, measured, number, radians};
use kurbo::{Affine, Vec2};
use svgtypes::Transform;

/// What the lengths of a transform refer to.
#[derive(Clone, Copy)]
pub(crate) struct Base {
    pub fonts: Fonts,
    /// Width and height of the reference box, for percentages.
    pub size: (f64, f64),
    /// The value is of CSS: lengths have units.
    pub css: bool,
}

impl Base {
    pub fn length(&self, text: &str, whole: f64) -> Value<f64> {
        length(text, self.fonts, !self.css).map(|v| v.of(whole))
    }
}

/// An angle in radians.
fn angle(text: &str) -> Value<f64> {
    measured(text, NUMBER, |v, unit| match unit {
        "" if v == 0.0 => Ok(0.0),
        unit => radians(v, unit).ok_or(Wrong),
    })
}

/// Reads a list of transform functions.
pub(crate) fn transform(text: &str, base: Base) -> Value<Affine> {
    let mut rest = text.trim();
    let mut product = Affine::IDENTITY;
    if rest.eq_ignore_ascii_case("none") {
        return Ok(product);
    }
    if !base.css {
        return of_attribute(rest).ok_or(Wrong);
    }
    while !rest.is_empty() {
        let (name, after) = rest.split_once('(').ok_or(Wrong)?;
        // Parentheses within are of functions such as calc(), which are not read.
        let (arguments, after) = after.split_once(')').ok_or(Wrong)?;
        let arguments: Vec<&str> = arguments.split(',').map(str::trim).collect();
        product *= function(name, &arguments, base)?;
        rest = after.trim_start();
    }
    Some(product).filter(Affine::is_finite).ok_or(Wrong)
}

/// The attribute `transform`. Its parser takes a comma at the end of a list, browsers do not.
fn of_attribute(text: &str) -> Option<Affine> {
    if text.split(')').any(|part| part.trim_end().ends_with(',')) {
        return None;
    }
    let Transform { a, b, c, d, e, f } = text.parse().ok()?;
    Some(Affine::new([a, b, c, d, e, f])).filter(Affine::is_finite)
}

/// The remedy for transforms in space.
const MATRIX: &str = "write the transform with matrix(a, b, c, d, e, f)";

fn function(name: &str, arguments: &[&str], base: Base) -> Value<Affine> {
    let (width, height) = base.size;
    if arguments.iter().any(|a| a.contains('(')) {
        return Err(Unread(NUMBER));
    }
    Ok(match (name.to_ascii_lowercase().as_str(), arguments) {
        ("matrix", &[a, b, c, d, e, f]) => {
            let mut values = [0.0; 6];
            for (value, text) in values.iter_mut().zip([a, b, c, d, e, f]) {
                *value = number(text)?;
            }
            Affine::new(values)
        }
        ("translate" | "translatex", &[x]) => Affine::translate((base.length(x, width)?, 0.0)),
        ("translate", &[x, y]) => {
            Affine::translate((base.length(x, width)?, base.length(y, height)?))
        }
        ("translatey", &[y]) => Affine::translate((0.0, base.length(y, height)?)),
        ("scale", &[s]) => Affine::scale(factor(s)?),
        ("scale", &[x, y]) => Affine::scale_non_uniform(factor(x)?, factor(y)?),
        ("scalex", &[x]) => Affine::scale_non_uniform(factor(x)?, 1.0),
        ("scaley", &[y]) => Affine::scale_non_uniform(1.0, factor(y)?),
        ("rotate" | "rotatez", &[turn]) => Affine::rotate(angle(turn)?),
        ("skewx" | "skew", &[x]) => Affine::skew(angle(x)?.tan(), 0.0),
        ("skewy", &[y]) => Affine::skew(0.0, angle(y)?.tan()),
        ("skew", &[x, y]) => Affine::skew(angle(x)?.tan(), angle(y)?.tan()),
        (name, _) if is_spatial(name) => return Err(Unread(MATRIX)),
        _ => return Err(Wrong),
    })
}

fn is_spatial(name: &str) -> bool {
    name.ends_with("3d")
        || matches!(
            name,
            "rotatex" | "rotatey" | "translatez" | "scalez" | "perspective"
        )
}

/// The property `translate`, `rotate` or `scale`.
pub(crate) fn property(text: &str, name: &str, base: Base) -> Value<Affine> {
    let arguments = list(text);
    match arguments.as_slice() {
        ["none"] => Ok(Affine::IDENTITY),
        &[_, _, _] | &[_, _, _, _] => Err(Unread(MATRIX)),
        arguments => function(name, arguments, base),
    }
}

/// The property `transform-origin`, within the reference box.
pub(crate) fn origin(text: &str, base: Base) -> Value<Vec2> {
    let (width, height) = base.size;
    let text = text.to_ascii_lowercase();
    let parts = list(&text);
    let (mut x, mut y) = match parts.as_slice() {
        &[x] => (x, "center"),
        &[x, y] | &[x, y, _] => (x, y),
        _ => return Err(Wrong),
    };
    if matches!(x, "top" | "bottom") || matches!(y, "left" | "right") {
        (x, y) = (y, x);
    }
    let place = |text: &str, whole: f64| match text {
        "left" | "top" => Ok(0.0),
        "center" => Ok(0.5 * whole),
        "right" | "bottom" => Ok(whole),
        text => base.length(text, whole),
    };
    Ok(Vec2::new(place(x, width)?, place(y, height)?))
}
