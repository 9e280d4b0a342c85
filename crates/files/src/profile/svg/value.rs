//! Values of attributes and of CSS properties: numbers, lengths, lists.

use roxmltree::Node;

/// The reading of a value.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Value<T> {
    Is(T),
    /// Read only in part; the text says how.
    Near(T, &'static str),
    /// Not valid: browsers ignore it.
    Wrong,
    /// Valid in browsers and not read here; the text is the remedy.
    Unread(&'static str),
}

impl<T> Value<T> {
    pub fn from_option(value: Option<T>) -> Self {
        value.map_or(Self::Wrong, Self::Is)
    }

    pub fn map<U>(self, f: impl FnOnce(T) -> U) -> Value<U> {
        match self {
            Self::Is(v) => Value::Is(f(v)),
            Self::Near(v, how) => Value::Near(f(v), how),
            Self::Wrong => Value::Wrong,
            Self::Unread(remedy) => Value::Unread(remedy),
        }
    }

    pub fn ok(self) -> Option<T> {
        match self {
            Self::Is(v) | Self::Near(v, _) => Some(v),
            Self::Wrong | Self::Unread(_) => None,
        }
    }
}

/// A length in user units, or a part of the viewport.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Length {
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
pub(super) struct Fonts {
    pub own: f64,
    pub root: f64,
}

/// Splits a leading number off.
pub(super) fn split_number(text: &str) -> Option<(f64, &str)> {
    let bytes = text.as_bytes();
    let digits = |mut at: usize| {
        while bytes.get(at).is_some_and(u8::is_ascii_digit) {
            at += 1;
        }
        at
    };
    let sign = usize::from(matches!(bytes.first(), Some(b'+' | b'-')));
    let mut end = digits(sign);
    let mut count = end - sign;
    if bytes.get(end) == Some(&b'.') {
        let fraction = digits(end + 1);
        count += fraction - end - 1;
        end = fraction;
    }
    if count == 0 {
        return None;
    }
    if matches!(bytes.get(end), Some(b'e' | b'E')) {
        let sign = usize::from(matches!(bytes.get(end + 1), Some(b'+' | b'-')));
        let exponent = digits(end + 1 + sign);
        if exponent > end + 1 + sign {
            end = exponent;
        }
    }
    let number: f64 = text[..end].parse().ok()?;
    number.is_finite().then_some((number, &text[end..]))
}

pub(super) fn number(text: &str) -> Value<f64> {
    match split_number(text) {
        Some((v, "")) => Value::Is(v),
        None if text.contains('(') => Value::Unread("write a number"),
        _ => Value::Wrong,
    }
}

/// A number or percentage from 0 to 1.
pub(super) fn alpha(text: &str) -> Value<f32> {
    match split_number(text) {
        Some((v, "")) => Value::Is(v.clamp(0.0, 1.0) as f32),
        Some((v, "%")) => Value::Is((v / 100.0).clamp(0.0, 1.0) as f32),
        None if text.contains('(') => Value::Unread("write a number"),
        _ => Value::Wrong,
    }
}

/// A length. `plain` lengths need no unit.
pub(super) fn length(text: &str, fonts: Fonts, plain: bool) -> Value<Length> {
    let Some((v, unit)) = split_number(text) else {
        return match text.contains('(') {
            true => Value::Unread("write the length in px"),
            false => Value::Wrong,
        };
    };
    let factor = match unit.to_ascii_lowercase().as_str() {
        "" if plain || v == 0.0 => 1.0,
        "px" => 1.0,
        "%" => return Value::Is(Length::Part(v / 100.0)),
        "em" => fonts.own,
        "rem" => fonts.root,
        "ex" | "ch" => 0.5 * fonts.own,
        "in" => 96.0,
        "cm" => 96.0 / 2.54,
        "mm" => 96.0 / 25.4,
        "q" => 96.0 / 101.6,
        "pt" => 96.0 / 72.0,
        "pc" => 16.0,
        u if u.starts_with(['v', 'd', 's', 'l', 'c', 'r', 'i']) && is_css_unit(u) => {
            return Value::Unread("write the length in px");
        }
        _ => return Value::Wrong,
    };
    Value::Is(Length::Px(v * factor))
}

/// Units of CSS that depend on the window or on fonts that are not read.
fn is_css_unit(unit: &str) -> bool {
    let of_window = |u: &str| matches!(u, "vw" | "vh" | "vi" | "vb" | "vmin" | "vmax");
    let sized = |c: char| unit.strip_prefix(c).is_some_and(of_window);
    of_window(unit)
        || ['d', 's', 'l'].into_iter().any(sized)
        || matches!(
            unit,
            "lh" | "rlh"
                | "cap"
                | "rcap"
                | "ic"
                | "ric"
                | "rex"
                | "rch"
                | "cqw"
                | "cqh"
                | "cqi"
                | "cqb"
                | "cqmin"
                | "cqmax"
        )
}

/// The parts of a list that blanks or commas separate, outside of parentheses.
pub(super) fn list(text: &str) -> Vec<&str> {
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

/// An attribute of SVG: those of other namespaces do not count.
pub(super) fn attribute<'n>(node: Node<'n, '_>, name: &str) -> Option<&'n str> {
    let mut own = node.attributes();
    let found = own.find(|a| a.namespace().is_none() && a.name() == name);
    found.map(|a| a.value())
}

/// Text with the escapes of CSS resolved.
pub(super) fn unescaped(text: &str) -> String {
    let mut out = String::with_capacity(text.len());
    let mut rest = text;
    while let Some((before, after)) = rest.split_once('\\') {
        out.push_str(before);
        let digits = after
            .bytes()
            .take(6)
            .take_while(u8::is_ascii_hexdigit)
            .count();
        let code = u32::from_str_radix(&after[..digits], 16);
        let letter = code.ok().and_then(char::from_u32);
        let own = after.chars().next().filter(|_| digits == 0);
        out.extend(letter.or(own));
        rest = &after[digits.max(own.map_or(0, char::len_utf8))..];
        if digits > 0 {
            rest = rest
                .strip_prefix(|c: char| c.is_ascii_whitespace())
                .unwrap_or(rest);
        }
    }
    out.push_str(rest);
    out
}

/// The target of `url(#name)` and the text after it: `Ok` for one in the drawing, `Err` for an
/// address elsewhere.
pub(super) fn url(text: &str) -> Option<(Result<&str, &str>, &str)> {
    let head = text.get(..4)?;
    if !head.eq_ignore_ascii_case("url(") {
        return None;
    }
    let inner = text[4..].trim_start();
    let quote = inner.chars().next().filter(|c| matches!(c, '"' | '\''));
    let (address, rest) = match quote {
        Some(q) => {
            let (address, rest) = inner[1..].split_once(q)?;
            (address, rest.trim_start().strip_prefix(')')?)
        }
        None => inner.split_once(')')?,
    };
    let address = address.trim();
    let target = address.strip_prefix('#').ok_or(address);
    Some((target, rest.trim()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_and_lengths() {
        let fonts = Fonts {
            own: 10.0,
            root: 16.0,
        };
        let px = |text| length(text, fonts, true);
        for (text, wanted) in [
            ("5", 5.0),
            (".5", 0.5),
            ("-5.", -5.0),
            ("+1e2", 100.0),
            ("2em", 20.0),
            ("1rem", 16.0),
            ("1in", 96.0),
            ("3PX", 3.0),
        ] {
            assert_eq!(px(text), Value::Is(Length::Px(wanted)), "{text}");
        }
        assert_eq!(px("50%"), Value::Is(Length::Part(0.5)));
        for unread in ["calc(1px + 2px)", "5vw", "1dvh"] {
            assert!(matches!(px(unread), Value::Unread(_)), "{unread}");
        }
        for wrong in ["", "e5", "5 5", "inf", "nan", "5furlong", "."] {
            assert_eq!(px(wrong), Value::Wrong, "{wrong}");
        }
        assert_eq!(length("5", fonts, false), Value::Wrong);
        assert_eq!(length("0", fonts, false), Value::Is(Length::ZERO));
        assert_eq!(alpha("150%"), Value::Is(1.0));
    }

    #[test]
    fn lists_and_addresses() {
        assert_eq!(list("a, b(1, 2)  c"), ["a", "b(1, 2)", "c"]);
        assert_eq!(url("url(#a) red"), Some((Ok("a"), "red")));
        assert_eq!(url("URL( '#a b' )"), Some((Ok("a b"), "")));
        assert_eq!(url("url(b.svg#a)"), Some((Err("b.svg#a"), "")));
        assert_eq!(url("red"), None);
        assert_eq!(url("url(#a"), None);
    }
}
