//! Custom properties of CSS, and the values that refer to them by `var()`.

use crate::css::cascade::{Declared, Wide};
use crate::notes::{Fault, Result};
use std::borrow::Cow;
use std::collections::HashMap;
use std::rc::Rc;

/// Custom properties of CSS (`--name`), inherited.
pub(crate) type Custom = Rc<HashMap<String, String>>;

/// Fallbacks of custom properties may be nested this deep.
const MOST_NESTED: usize = 64;
/// Longest value after custom properties are filled in, bytes.
const MOST_BYTES: usize = 1 << 16;

impl Declared {
    /// The custom properties of an element whose parent has `inherited`.
    ///
    /// # Errors
    /// If one is set back to a value that is not known here.
    pub fn custom(&self, inherited: &Custom) -> Result<Custom> {
        let own = self.properties.iter();
        let own = own.filter(|(name, _)| name.starts_with("--"));
        let own = own.filter_map(|(name, list)| Some((name.as_str(), list.first()?)));
        let own: HashMap<&str, &str> = own.map(|(name, d)| (name, d.value.as_str())).collect();
        if own.is_empty() {
            return Ok(Rc::clone(inherited));
        }
        let mut filling = Filling {
            own: &own,
            inherited,
            done: HashMap::new(),
        };
        for (name, value) in &own {
            if ["revert", "revert-layer"].contains(&value.to_ascii_lowercase().as_str()) {
                return Err(Fault::new(format!(
                    "the drawing has \"{name}: {value}\", which is not read; write the value itself"
                )));
            }
            filling.value(name, 0);
        }
        let mut all = HashMap::clone(inherited);
        for (name, value) in filling.done {
            match value {
                Some(value) => drop(all.insert(name, value)),
                None => drop(all.remove(&name)),
            }
        }
        Ok(Rc::new(all))
    }
}

/// The custom properties of one element while references between them are followed.
struct Filling<'a> {
    own: &'a HashMap<&'a str, &'a str>,
    inherited: &'a Custom,
    /// `None` for those that are not valid, and for those that are being read.
    done: HashMap<String, Option<String>>,
}

impl Filling<'_> {
    /// The value of a custom property with all references filled in.
    fn value(&mut self, name: &str, depth: usize) -> Option<String> {
        let before = || self.inherited.get(name).cloned();
        if let Some(done) = self.done.get(name) {
            return done.clone();
        }
        let Some(text) = self.own.get(name) else {
            return before();
        };
        let value = match Wide::of(text) {
            Some(Wide::Initial) => None,
            Some(_) => before(),
            None => {
                self.done.insert(name.to_owned(), None);
                substituted(text, &mut |n| self.value(n, depth + 1), depth)
            }
        };
        self.done.insert(name.to_owned(), value.clone());
        value
    }
}

/// A value with custom properties filled in. `None` if one is not set.
pub(crate) fn filled<'a>(text: &'a str, custom: &Custom) -> Option<Cow<'a, str>> {
    match text.contains("var(") {
        true => substituted(text, &mut |name| custom.get(name).cloned(), 0)
            .map(|value| Cow::Owned(value.trim().to_owned())),
        false => Some(Cow::Borrowed(text)),
    }
}

/// Fills in what `value` gives for the names of custom properties. `None` if that is not set.
fn substituted(
    text: &str,
    value: &mut dyn FnMut(&str) -> Option<String>,
    depth: usize,
) -> Option<String> {
    if depth > MOST_NESTED {
        return None;
    }
    let mut out = String::new();
    let mut rest = text;
    while let Some((before, after)) = rest.split_once("var(") {
        let mut open = 1;
        let end = after.char_indices().find_map(|(i, c)| {
            open += i32::from(c == '(') - i32::from(c == ')');
            (open == 0).then_some(i)
        })?;
        let (name, fallback) = match after[..end].split_once(',') {
            Some((name, fallback)) => (name, Some(fallback)),
            None => (&after[..end], None),
        };
        out.push_str(before);
        match (value(name.trim()), fallback) {
            (Some(own), _) => out.push_str(own.trim()),
            (None, fallback) => out.push_str(substituted(fallback?, value, depth + 1)?.trim()),
        }
        if out.len() > MOST_BYTES {
            return None;
        }
        rest = &after[end + 1..];
    }
    out.push_str(rest);
    Some(out)
}
