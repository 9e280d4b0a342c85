//! Transforms of attributes (`rotate(90 5 5)`) and of CSS (`rotate(90deg)`).

use crate::value::{Fonts, NUMBER, Value, length, list, number, radians, split_number};
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
    match split_number(text) {
        Some((0.0, "")) => Value::Is(0.0),
        Some((v, unit)) => Value::from_option(radians(v, unit)),
        None => Value::none(text, NUMBER),
    }
}

/// Reads a list of transform functions.
pub(crate) fn transform(text: &str, base: Base) -> Value<Affine> {
    let mut rest = text.trim();
    let mut product = Affine::IDENTITY;
    if rest.eq_ignore_ascii_case("none") {
        return Value::Is(product);
    }
    if !base.css {
        return Value::from_option(of_attribute(rest));
    }
    while !rest.is_empty() {
        let Some((name, after)) = rest.split_once('(') else {
            return Value::Wrong;
        };
        // Parentheses within are of functions such as calc(), which are not read.
        let Some((arguments, after)) = after.split_once(')') else {
            return Value::Wrong;
        };
        let arguments: Vec<&str> = arguments.split(',').map(str::trim).collect();
        match function(name, &arguments, base) {
            Value::Is(factor) => product *= factor,
            other => return other,
        }
        rest = after.trim_start();
    }
    Value::from_option(Some(product).filter(Affine::is_finite))
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

/// The first value that is not read ends the function.
macro_rules! read {
    ($value:expr) => {
        match $value {
            Value::Is(v) | Value::Near(v, _) => v,
            Value::Wrong => return Value::Wrong,
            Value::Unread(remedy) => return Value::Unread(remedy),
        }
    };
}

fn function(name: &str, arguments: &[&str], base: Base) -> Value<Affine> {
    let (width, height) = base.size;
    if arguments.iter().any(|a| a.contains('(')) {
        return Value::Unread(NUMBER);
    }
    Value::Is(match (name.to_ascii_lowercase().as_str(), arguments) {
        ("matrix", &[a, b, c, d, e, f]) => {
            let mut values = [0.0; 6];
            for (value, text) in values.iter_mut().zip([a, b, c, d, e, f]) {
                *value = read!(number(text));
            }
            Affine::new(values)
        }
        ("translate" | "translatex", &[x]) => {
            Affine::translate((read!(base.length(x, width)), 0.0))
        }
        ("translate", &[x, y]) => {
            Affine::translate((read!(base.length(x, width)), read!(base.length(y, height))))
        }
        ("translatey", &[y]) => Affine::translate((0.0, read!(base.length(y, height)))),
        ("scale", &[s]) => Affine::scale(read!(factor(s))),
        ("scale", &[x, y]) => Affine::scale_non_uniform(read!(factor(x)), read!(factor(y))),
        ("scalex", &[x]) => Affine::scale_non_uniform(read!(factor(x)), 1.0),
        ("scaley", &[y]) => Affine::scale_non_uniform(1.0, read!(factor(y))),
        ("rotate" | "rotatez", &[turn]) => Affine::rotate(read!(angle(turn))),
        ("skewx" | "skew", &[x]) => Affine::skew(read!(angle(x)).tan(), 0.0),
        ("skewy", &[y]) => Affine::skew(0.0, read!(angle(y)).tan()),
        ("skew", &[x, y]) => Affine::skew(read!(angle(x)).tan(), read!(angle(y)).tan()),
        (name, _) if is_spatial(name) => return Value::Unread(MATRIX),
        _ => return Value::Wrong,
    })
}

fn is_spatial(name: &str) -> bool {
    name.ends_with("3d")
        || matches!(
            name,
            "rotatex" | "rotatey" | "translatez" | "scalez" | "perspective"
        )
}

fn factor(text: &str) -> Value<f64> {
    match split_number(text) {
        Some((v, "%")) => Value::Is(v / 100.0),
        _ => number(text),
    }
}

/// The property `translate`, `rotate` or `scale`.
pub(crate) fn property(text: &str, name: &str, base: Base) -> Value<Affine> {
    let arguments = list(text);
    match arguments.as_slice() {
        ["none"] => Value::Is(Affine::IDENTITY),
        &[_, _, _] | &[_, _, _, _] => Value::Unread(MATRIX),
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
        _ => return Value::Wrong,
    };
    if matches!(x, "top" | "bottom") || matches!(y, "left" | "right") {
        (x, y) = (y, x);
    }
    let place = |text: &str, whole: f64| match text {
        "left" | "top" => Value::Is(0.0),
        "center" => Value::Is(0.5 * whole),
        "right" | "bottom" => Value::Is(whole),
        text => base.length(text, whole),
    };
    Value::Is(Vec2::new(read!(place(x, width)), read!(place(y, height))))
}
