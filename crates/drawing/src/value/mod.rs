//! Values of attributes and of CSS properties: numbers, lengths, lists.

pub(crate) mod color;
pub(crate) mod paint;
pub(crate) mod transform;

use crate::element::is_in;
use Unusable::{Unread, Wrong};
use std::rc::Rc;

/// A value that is read, or why it is not.
pub(crate) type Value<T> = Result<T, Unusable>;

/// Why a value is not read.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Unusable {
    /// Not valid: browsers ignore it.
    Wrong,
    /// Valid in browsers and not read here; the text is the remedy.
    Unread(&'static str),
}

/// The value of a number and its unit. Other text is not read if it is a function, else not valid.
pub(crate) fn measured<T>(
    text: &str,
    remedy: &'static str,
    value: impl FnOnce(f64, &str) -> Value<T>,
) -> Value<T> {
    match split_number(text) {
        Some((number, unit)) => value(number, unit),
        None if text.contains('(') => Err(Unread(remedy)),
        None => Err(Wrong),
    }
}

/// A length in user units, or a part of the viewport.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Length {
    Px(f64),
    /// A fraction, not percent.
    Part(f64),
}

impl Length {
    pub const ZERO: Self = Self::Px(0.0);

    /// The length in user units; `whole` is what percentages are of.
    pub fn of(self, whole: f64) -> f64 {
        match self {
            Self::Px(v) => v,
            Self::Part(v) => v * whole,
        }
    }
}

/// Sizes of fonts that lengths refer to, in pixels.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Fonts {
    pub own: f64,
    pub root: f64,
}

/// Splits a leading number off.
pub(crate) fn split_number(text: &str) -> Option<(f64, &str)> {
    let after_digits = |text| str::trim_start_matches(text, |c: char| c.is_ascii_digit());
    let after_sign = |text| str::strip_prefix(text, ['+', '-']).unwrap_or(text);
    let mut rest = after_digits(after_sign(text));
    rest = rest.strip_prefix('.').map_or(rest, after_digits);
    if let Some(exponent) = rest.strip_prefix(['e', 'E']).map(after_sign)
        && exponent.starts_with(|c: char| c.is_ascii_digit())
    {
        rest = after_digits(exponent);
    }
    let number: f64 = text[..text.len() - rest.len()].parse().ok()?;
    number.is_finite().then_some((number, rest))
}

/// Remedies.
pub(crate) const NUMBER: &str = "write a number";
const LENGTH: &str = "write the length in px";
/// Units of CSS that depend on the window or on fonts that are not read.
const UNREAD_UNITS: &str = "vw vh vi vb vmin vmax dvw dvh dvi dvb dvmin dvmax svw svh svi svb svmin svmax \
    lvw lvh lvi lvb lvmin lvmax lh rlh cap rcap ic ric rex rch cqw cqh cqi cqb cqmin cqmax";

pub(crate) fn number(text: &str) -> Value<f64> {
    let plain = |v: f64, unit: &str| unit.is_empty().then_some(v).ok_or(Wrong);
    measured(text, NUMBER, plain)
}

/// A number or percentage.
pub(crate) fn factor(text: &str) -> Value<f64> {
    measured(text, NUMBER, |v, unit| match unit {
        "" => Ok(v),
        "%" => Ok(v / 100.0),
        _ => Err(Wrong),
    })
}

/// A number or percentage from 0 to 1.
pub(crate) fn alpha(text: &str, _: bool) -> Value<f32> {
    factor(text).map(|v| v.clamp(0.0, 1.0) as f32)
}

/// A length. `plain` lengths need no unit.
pub(crate) fn length(text: &str, fonts: Fonts, plain: bool) -> Value<Length> {
    measured(text, LENGTH, |v, unit| {
        let factor = match unit.to_ascii_lowercase().as_str() {
            "" if plain || v == 0.0 => 1.0,
            "px" => 1.0,
            "%" => return Ok(Length::Part(v / 100.0)),
            "em" => fonts.own,
            "rem" => fonts.root,
            "ex" | "ch" => 0.5 * fonts.own,
            "in" => 96.0,
            "cm" => 96.0 / 2.54,
            "mm" => 96.0 / 25.4,
            "q" => 96.0 / 101.6,
            "pt" => 96.0 / 72.0,
            "pc" => 16.0,
            unit if is_in(UNREAD_UNITS, unit) => return Err(Unread(LENGTH)),
            _ => return Err(Wrong),
        };
        Ok(Length::Px(v * factor))
    })
}

/// An angle of CSS in radians, by its number and unit.
pub(crate) fn radians(number: f64, unit: &str) -> Option<f64> {
    Some(match unit {
        "deg" => number.to_radians(),
        "rad" => number,
        "grad" => (0.9 * number).to_radians(),
        "turn" => number * std::f64::consts::TAU,
        _ => return None,
    })
}

/// The parts of a list that blanks or commas separate, outside of parentheses.
pub(crate) fn list(text: &str) -> Vec<&str> {
    let (mut parts, mut start, mut depth) = (Vec::new(), 0, 0usize);
    for (i, c) in text.char_indices() {
        match c {
            '(' => depth += 1,
            ')' => depth = depth.saturating_sub(1),
            _ => {}
        }
        if depth == 0 && (c.is_ascii_whitespace() || c == ',') {
            parts.push(&text[start..i]);
            start = i + 1;
        }
    }
    parts.push(&text[start..]);
    parts.retain(|p| !p.is_empty());
    parts
}

/// An element of the drawing by its id, or the address of one elsewhere.
pub(crate) type Target = std::result::Result<Rc<str>, Rc<str>>;

/// The target of `url(#name)` and the text after it.
pub(crate) fn url(text: &str) -> Option<(Target, &str)> {
    let mut input = cssparser::Parser::new(text);
    let address = input.expect_url().ok()?;
    let (function, rest) = text.split_at(input.position().byte_index());
    let target = match address.trim().strip_prefix('#') {
        Some(id) => Ok(id.into()),
        None => Err(address.trim().into()),
    };
    function.ends_with(')').then(|| (target, rest.trim()))
}
