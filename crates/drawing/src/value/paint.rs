//! Values of properties: words, paints, addresses.

use crate::element::is_in;
use crate::value::Unusable::Wrong;
use crate::value::color::{Color, color};
use crate::value::{Length, Target, Value, list, url};
use std::rc::Rc;

/// A paint as declared.
#[derive(Clone, Debug)]
pub(crate) enum Paint {
    None,
    Color(Color),
    Current,
    /// The fill (`false`) or stroke (`true`) of what uses a marker or a symbol.
    Context(bool),
    /// A gradient or pattern, and what counts if it is missing.
    Server(Target, Option<Box<Paint>>),
    /// A paint that is not read; the refusal, if anything is painted with it.
    Fault(Rc<str>),
}

/// A reading of one of these words, which blanks separate, as the value in its place.
pub(crate) fn words<T: Copy, const N: usize>(
    names: &'static str,
    values: [T; N],
) -> impl Fn(&str, bool) -> Value<T> {
    move |text: &str, _: bool| {
        let mut pairs = names.split(' ').zip(values);
        let found = pairs.find(|(name, _)| text.eq_ignore_ascii_case(name));
        found.map(|(_, value)| value).ok_or(Wrong)
    }
}

pub(crate) fn positive(length: Value<Length>) -> Value<Length> {
    match length {
        Ok(Length::Px(v) | Length::Part(v)) if v < 0.0 => Err(Wrong),
        other => other,
    }
}

pub(crate) fn paint(text: &str, _: bool) -> Value<Paint> {
    if let Some((target, fallback)) = url(text) {
        if fallback.is_empty() {
            return Ok(Paint::Server(target, None));
        }
        // Only a colour may follow.
        if url(fallback).is_some() {
            return Err(Wrong);
        }
        return paint(fallback, true).map(|f| Paint::Server(target, Some(Box::new(f))));
    }
    match text.to_ascii_lowercase().as_str() {
        "none" => Ok(Paint::None),
        "currentcolor" => Ok(Paint::Current),
        "context-fill" => Ok(Paint::Context(false)),
        "context-stroke" => Ok(Paint::Context(true)),
        _ => color(text).map(Paint::Color),
    }
}

/// Returns true for words of `display` that show an element.
pub(crate) fn is_display(word: &str) -> bool {
    let plain = word.split(['-', ' ']).next().unwrap_or_default();
    is_in("inline block flex grid table list flow ruby run", plain)
}

/// `none` or `url(#name)`.
pub(crate) fn target(text: &str, _: bool) -> Value<Option<Target>> {
    if text.eq_ignore_ascii_case("none") {
        return Ok(None);
    }
    match url(text) {
        Some((target, "")) => Ok(Some(target)),
        _ => Err(Wrong),
    }
}

/// The property `d`, which browsers read from CSS as `path("...")`.
pub(crate) fn path_data(text: &str, css: bool) -> Value<Option<String>> {
    if !css {
        return Ok(Some(text.to_owned()));
    }
    if text.eq_ignore_ascii_case("none") {
        return Ok(None);
    }
    let inner = text.strip_prefix("path(").and_then(|t| t.strip_suffix(')'));
    let quoted = inner.map(str::trim).and_then(|t| {
        let within = |q: char| t.strip_prefix(q).and_then(|t| t.strip_suffix(q));
        within('"').or_else(|| within('\''))
    });
    quoted.map(|t| Some(t.to_owned())).ok_or(Wrong)
}

/// The order of painting: what is named comes first.
pub(crate) fn order(text: &str, _: bool) -> Value<[u8; 3]> {
    let text = text.to_ascii_lowercase();
    let named = if text == "normal" {
        Vec::new()
    } else {
        list(&text)
    };
    let mut order = Vec::new();
    for word in named {
        match ["fill", "stroke", "markers"]
            .iter()
            .position(|w| *w == word)
        {
            Some(k) if !order.contains(&(k as u8)) => order.push(k as u8),
            _ => return Err(Wrong),
        }
    }
    let rest: Vec<u8> = (0..3).filter(|k| !order.contains(k)).collect();
    [order, rest].concat().try_into().map_err(|_| Wrong)
}
