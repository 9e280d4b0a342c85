//! Reads the text of selectors.

use super::selector::{Combinator, Selector, Test};
use super::value::escape;

/// `:is(:not(:is(...)))` may be nested this deep.
const MOST_NESTED: usize = 8;

/// Pseudo-elements, such as `::selection`.
const ELEMENTS: &str = "before after selection marker first-line first-letter";
/// Pseudo-classes that no element of a still picture has, and pseudo-elements in older notation.
const NEVER: &str = "hover active focus focus-visible focus-within visited target checked disabled enabled before \
    after first-line first-letter";

/// Reads selectors that commas separate. `None` for one that is not read.
pub(super) fn selectors(text: &str) -> Option<Vec<Selector>> {
    nested(text, 0)
}

fn nested(text: &str, depth: usize) -> Option<Vec<Selector>> {
    if depth > MOST_NESTED {
        return None;
    }
    let mut list = Vec::new();
    let mut cursor = Cursor { rest: text.trim() };
    loop {
        list.push(cursor.selector(depth)?);
        match cursor.take(',') {
            true => cursor.blanks(),
            false if cursor.rest.is_empty() => return Some(list),
            false => return None,
        };
    }
}

struct Cursor<'a> {
    rest: &'a str,
}

impl<'a> Cursor<'a> {
    fn take(&mut self, c: char) -> bool {
        let after = self.rest.strip_prefix(c);
        self.rest = after.unwrap_or(self.rest);
        after.is_some()
    }

    fn blanks(&mut self) -> bool {
        let after = self.rest.trim_start();
        let any = after.len() < self.rest.len();
        self.rest = after;
        any
    }

    /// A name, with escapes resolved.
    fn name(&mut self) -> Option<String> {
        let mut name = String::new();
        while let Some(c) = self.rest.chars().next() {
            let (letter, length) = match c {
                '\\' => {
                    let (letter, length) = escape(&self.rest[1..]);
                    (letter?, 1 + length)
                }
                c if c.is_alphanumeric() || matches!(c, '-' | '_') || !c.is_ascii() => {
                    (c, c.len_utf8())
                }
                _ => break,
            };
            name.push(letter);
            self.rest = &self.rest[length..];
        }
        (!name.is_empty()).then_some(name)
    }

    /// The text up to the parenthesis that closes the one before it.
    fn arguments(&mut self) -> Option<&'a str> {
        let mut depth = 1;
        for (i, c) in self.rest.char_indices() {
            match c {
                '(' => depth += 1,
                ')' => depth -= 1,
                _ => {}
            }
            if depth == 0 {
                let inner = &self.rest[..i];
                self.rest = &self.rest[i + 1..];
                return Some(inner.trim());
            }
        }
        None
    }

    fn selector(&mut self, depth: usize) -> Option<Selector> {
        let mut selector = Selector {
            parts: Vec::new(),
            specificity: [0; 3],
        };
        let mut combinator = Combinator::Descendant;
        loop {
            let tests = self.compound(depth, &mut selector.specificity)?;
            selector.parts.push((combinator, tests));
            let blank = self.blanks();
            combinator = match self.rest.chars().next() {
                None | Some(',') => return Some(selector),
                Some('>') => Combinator::Child,
                Some('+') => Combinator::Next,
                Some('~') => Combinator::Later,
                Some(_) if blank => Combinator::Descendant,
                Some(_) => return None,
            };
            if combinator != Combinator::Descendant {
                self.rest = &self.rest[1..];
                self.blanks();
            }
        }
    }

    fn compound(&mut self, depth: usize, specificity: &mut [u32; 3]) -> Option<Vec<Test>> {
        let mut tests = Vec::new();
        let mut universal = self.take('*');
        if !universal && let Some(name) = self.name() {
            tests.push(Test::Type(name));
        }
        if self.take('|') {
            // A prefix of a namespace: drawings have one. Without a prefix, it is none.
            if !universal && tests.is_empty() {
                tests.push(Test::Never);
                universal = self.take('*') || self.name().is_some();
                return universal.then_some(tests);
            }
            tests.clear();
            universal = self.take('*');
            if !universal {
                tests.push(Test::Type(self.name()?));
            }
        }
        specificity[2] += tests.len() as u32;
        loop {
            if self.take('#') {
                tests.push(Test::Id(self.name()?));
                specificity[0] += 1;
            } else if self.take('.') {
                tests.push(Test::Class(self.name()?));
                specificity[1] += 1;
            } else if self.take('[') {
                tests.push(self.attribute()?);
                specificity[1] += 1;
            } else if self.take(':') {
                tests.extend(self.pseudo(depth, specificity)?);
            } else {
                break;
            }
        }
        (universal || !tests.is_empty()).then_some(tests)
    }

    /// The rest of `[name=value i]`.
    fn attribute(&mut self) -> Option<Test> {
        self.blanks();
        let mut name = self.name()?;
        // A prefix of a namespace, but not the operator `|=`.
        if self.rest.starts_with('|') && !self.rest.starts_with("|=") {
            self.take('|');
            name = self.name()?;
        }
        self.blanks();
        let mut how = ' ';
        let (mut value, mut any_case) = (String::new(), false);
        if !self.rest.starts_with(']') {
            how = self.rest.chars().next()?;
            if how != '=' && !matches!(how, '~' | '|' | '^' | '$' | '*') {
                return None;
            }
            self.take(how);
            if how != '=' && !self.take('=') {
                return None;
            }
            self.blanks();
            let quote = self.rest.chars().next().filter(|c| matches!(c, '"' | '\''));
            value = match quote {
                Some(q) => {
                    let (inside, after) = self.rest[1..].split_once(q)?;
                    self.rest = after;
                    inside.to_owned()
                }
                None => self.name()?,
            };
            self.blanks();
            any_case = self.take('i') || self.take('I');
            self.blanks();
        }
        self.take(']').then_some(Test::Attribute {
            name,
            how,
            value,
            any_case,
        })
    }

    fn pseudo(&mut self, depth: usize, specificity: &mut [u32; 3]) -> Option<Vec<Test>> {
        let is_element = self.take(':');
        let name = self.name()?.to_ascii_lowercase();
        let arguments = match self.take('(') {
            true => Some(self.arguments()?),
            false => None,
        };
        let is_in = |list: &str| list.split(' ').any(|known| known == name);
        if is_element {
            // Others make the rule invalid.
            let known = is_in(ELEMENTS) || name.starts_with("-webkit-");
            return known.then(|| vec![Test::Never]);
        }
        if let ("is" | "where" | "not" | "matches", Some(arguments)) = (name.as_str(), arguments) {
            let list = nested(arguments, depth + 1)?;
            if name != "where" {
                let most = list.iter().map(|s| s.specificity).max().unwrap_or_default();
                (0..3).for_each(|k| specificity[k] += most[k]);
            }
            return Some(vec![match name.as_str() {
                "not" => Test::NoneOf(list),
                _ => Test::AnyOf(list),
            }]);
        }
        specificity[1] += 1;
        let of_type = name.ends_with("-of-type");
        let nth = |(step, first): (i64, i64), from_end| Test::Nth {
            step,
            first,
            from_end,
            of_type,
        };
        let place = name.strip_suffix("-child");
        let place = place.or_else(|| name.strip_suffix("-of-type"));
        Some(match (place, name.as_str(), arguments) {
            (Some("first"), _, None) => vec![nth((0, 1), false)],
            (Some("last"), _, None) => vec![nth((0, 1), true)],
            (Some("only"), _, None) => vec![nth((0, 1), false), nth((0, 1), true)],
            (Some("nth"), _, Some(text)) => vec![nth(an_plus_b(text)?, false)],
            (Some("nth-last"), _, Some(text)) => vec![nth(an_plus_b(text)?, true)],
            (None, "root", None) => vec![Test::Root],
            (None, "empty", None) => vec![Test::Empty],
            (None, "link" | "any-link", None) => vec![Test::Link],
            (None, "defined", None) => Vec::new(),
            (None, _, None) if is_in(NEVER) => vec![Test::Never],
            _ => return None,
        })
    }
}

/// Reads `2n + 1`, `odd`, `even`, `-n+3`, `4`.
fn an_plus_b(text: &str) -> Option<(i64, i64)> {
    let text: String = text.to_ascii_lowercase().split_ascii_whitespace().collect();
    match text.as_str() {
        "odd" => return Some((2, 1)),
        "even" => return Some((2, 0)),
        _ => {}
    }
    let within = |v: &i64| v.abs() <= 1 << 40;
    let number = |text: &str| text.parse().ok().filter(within);
    let Some((step, first)) = text.split_once('n') else {
        return number(&text).map(|first| (0, first));
    };
    let step = match step {
        "" | "+" => 1,
        "-" => -1,
        step => number(step)?,
    };
    let first = if first.is_empty() { 0 } else { number(first)? };
    Some((step, first))
}
