//! Selectors of CSS: which elements a rule is for.

use super::value::attribute;
use roxmltree::{Node, NodeId};
use std::cell::Cell;
use std::collections::{HashMap, HashSet};

/// `:is(:not(:is(...)))` may be nested this deep.
const MOST_NESTED: usize = 8;

/// A selector without commas.
#[derive(Clone, Debug)]
pub(super) struct Selector {
    /// Each with what joins it to the one before it.
    parts: Vec<(Combinator, Vec<Test>)>,
    /// Number of ids, of classes and alike, of types.
    pub specificity: [u32; 3],
}

#[derive(Clone, Copy, Debug, PartialEq)]
enum Combinator {
    Descendant,
    Child,
    Next,
    Later,
}

#[derive(Clone, Debug)]
enum Test {
    Type(String),
    Id(String),
    Class(String),
    Attribute {
        name: String,
        how: char,
        value: String,
        any_case: bool,
    },
    /// `step * n + first` counts from the first or last among all siblings or those of one type.
    Nth {
        step: i64,
        first: i64,
        from_end: bool,
        of_type: bool,
    },
    Root,
    Empty,
    Link,
    Never,
    AnyOf(Vec<Selector>),
    NoneOf(Vec<Selector>),
}

/// What the last part of a selector asks for, so that few rules need be tried.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub(super) enum Key {
    Id(String),
    Class(String),
    Type(String),
    Any,
}

/// Most tries to match a part of a selector with an element, of one drawing.
const MOST_TRIES: u64 = 30_000_000;

/// The place of each element among its siblings.
pub(super) struct Places {
    places: HashMap<NodeId, Place>,
    tries: Cell<u64>,
}

#[derive(Clone, Copy, Default)]
struct Place {
    /// From 1; among all siblings, then among those of the same type.
    index: [i64; 2],
    count: [i64; 2],
}

impl Places {
    pub fn of(document: &roxmltree::Document) -> Self {
        let mut places = HashMap::new();
        for parent in document.descendants() {
            let mut counts: HashMap<&str, i64> = HashMap::new();
            let mut all = 0;
            let elements = || parent.children().filter(Node::is_element);
            for child in elements() {
                all += 1;
                let same = counts.entry(child.tag_name().name()).or_default();
                *same += 1;
                places.insert(
                    child.id(),
                    Place {
                        index: [all, *same],
                        count: [0; 2],
                    },
                );
            }
            for child in elements() {
                if let Some(place) = places.get_mut(&child.id()) {
                    let same = counts.get(child.tag_name().name()).copied();
                    place.count = [all, same.unwrap_or(1)];
                }
            }
        }
        Self {
            places,
            tries: Cell::new(0),
        }
    }

    /// Returns true after too many tries; then selectors match nothing.
    pub fn is_spent(&self) -> bool {
        self.tries.get() > MOST_TRIES
    }
}

impl Selector {
    /// What an element needs for the last part of the selector.
    pub fn key(&self) -> Key {
        let mut key = Key::Any;
        for test in self.parts.last().map_or(&[][..], |(_, tests)| tests) {
            match test {
                Test::Id(id) => return Key::Id(id.clone()),
                Test::Class(class) => key = Key::Class(class.clone()),
                Test::Type(name) if key == Key::Any => key = Key::Type(name.clone()),
                _ => {}
            }
        }
        key
    }

    /// Returns true if the selector is for this element.
    pub fn matches(&self, node: Node, places: &Places) -> bool {
        self.matches_to(self.parts.len(), node, places, &mut HashSet::new())
    }

    /// Matches the first `count` parts, the last of them with `node`. `failed` keeps the pairs that
    /// were tried without success, so that no pair is tried twice.
    fn matches_to(
        &self,
        count: usize,
        node: Node,
        places: &Places,
        failed: &mut HashSet<(usize, NodeId)>,
    ) -> bool {
        let Some((combinator, tests)) = self.parts[..count].last() else {
            return true;
        };
        places.tries.set(places.tries.get() + 1);
        if places.is_spent() {
            return false;
        }
        if !tests.iter().all(|t| t.matches(node, places)) {
            return false;
        }
        if count == 1 {
            return true;
        }
        if failed.contains(&(count, node.id())) {
            return false;
        }
        let mut before = |n: Node| self.matches_to(count - 1, n, places, failed);
        let found = match combinator {
            Combinator::Child => node.parent_element().is_some_and(before),
            Combinator::Next => node.prev_sibling_element().is_some_and(before),
            Combinator::Descendant => {
                let mut ancestors = node.ancestors().skip(1).filter(Node::is_element);
                ancestors.any(&mut before)
            }
            Combinator::Later => {
                let mut siblings = node.prev_siblings().skip(1).filter(Node::is_element);
                siblings.any(&mut before)
            }
        };
        if !found {
            failed.insert((count, node.id()));
        }
        found
    }
}

impl Test {
    fn matches(&self, node: Node, places: &Places) -> bool {
        match self {
            Self::Type(name) => node.tag_name().name() == name,
            Self::Id(id) => attribute(node, "id") == Some(id),
            Self::Class(class) => attribute(node, "class")
                .is_some_and(|c| c.split_ascii_whitespace().any(|c| c == class)),
            Self::Attribute {
                name,
                how,
                value,
                any_case,
            } => {
                let found = attribute(node, name);
                found.is_some_and(|a| match any_case {
                    true => compare(*how, &a.to_lowercase(), &value.to_lowercase()),
                    false => compare(*how, a, value),
                })
            }
            Self::Nth {
                step,
                first,
                from_end,
                of_type,
            } => {
                let place = places.places.get(&node.id()).copied().unwrap_or_default();
                let kind = usize::from(*of_type);
                let index = match from_end {
                    true => place.count[kind] + 1 - place.index[kind],
                    false => place.index[kind],
                };
                match (index.saturating_sub(*first), *step) {
                    (away, 0) => away == 0,
                    (away, step) => away % step == 0 && away / step >= 0,
                }
            }
            Self::Root => node.parent_element().is_none(),
            Self::Empty => node.children().all(|c| c.is_comment() || c.is_pi()),
            Self::Link => {
                node.tag_name().name() == "a" && node.attributes().any(|a| a.name() == "href")
            }
            Self::Never => false,
            Self::AnyOf(list) => list.iter().any(|s| s.matches(node, places)),
            Self::NoneOf(list) => !list.iter().any(|s| s.matches(node, places)),
        }
    }
}

fn compare(how: char, found: &str, wanted: &str) -> bool {
    match how {
        '=' => found == wanted,
        '~' => found.split_ascii_whitespace().any(|w| w == wanted),
        '|' => found
            .strip_prefix(wanted)
            .is_some_and(|r| r.is_empty() || r.starts_with('-')),
        '^' => !wanted.is_empty() && found.starts_with(wanted),
        '$' => !wanted.is_empty() && found.ends_with(wanted),
        '*' => !wanted.is_empty() && found.contains(wanted),
        _ => true,
    }
}

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
        let mut letters = self.rest.char_indices().peekable();
        let mut end = self.rest.len();
        while let Some((i, c)) = letters.next() {
            if c == '\\' {
                let hex: String = self.rest[i + 1..]
                    .chars()
                    .take(6)
                    .take_while(char::is_ascii_hexdigit)
                    .collect();
                if hex.is_empty() {
                    name.push(letters.next()?.1);
                } else {
                    name.push(
                        u32::from_str_radix(&hex, 16)
                            .ok()
                            .and_then(char::from_u32)?,
                    );
                    for _ in 0..hex.len() {
                        letters.next();
                    }
                    letters.next_if(|(_, c)| c.is_ascii_whitespace());
                }
            } else if c.is_alphanumeric() || matches!(c, '-' | '_') || !c.is_ascii() {
                name.push(c);
            } else {
                end = i;
                break;
            }
        }
        self.rest = &self.rest[end..];
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
                tests.push(self.pseudo(depth, specificity)?);
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

    fn pseudo(&mut self, depth: usize, specificity: &mut [u32; 3]) -> Option<Test> {
        if self.take(':') {
            // A pseudo-element, such as `::selection`. Others make the rule invalid.
            let name = self.name()?.to_ascii_lowercase();
            let known = [
                "before",
                "after",
                "selection",
                "marker",
                "first-line",
                "first-letter",
            ];
            let known = known.contains(&name.as_str()) || name.starts_with("-webkit-");
            known.then_some(())?;
            if self.take('(') {
                self.arguments()?;
            }
            return Some(Test::Never);
        }
        let name = self.name()?.to_ascii_lowercase();
        let arguments = match self.take('(') {
            true => Some(self.arguments()?),
            false => None,
        };
        if let ("is" | "where" | "not" | "matches", Some(arguments)) = (name.as_str(), arguments) {
            let list = nested(arguments, depth + 1)?;
            if name != "where" {
                let most = list.iter().map(|s| s.specificity).max().unwrap_or_default();
                (0..3).for_each(|k| specificity[k] += most[k]);
            }
            return Some(match name.as_str() {
                "not" => Test::NoneOf(list),
                _ => Test::AnyOf(list),
            });
        }
        specificity[1] += 1;
        let nth = |step, first, from_end, of_type| Test::Nth {
            step,
            first,
            from_end,
            of_type,
        };
        let counted = |from_end, of_type| {
            let (step, first) = an_plus_b(arguments?)?;
            Some(nth(step, first, from_end, of_type))
        };
        Some(match (name.as_str(), arguments) {
            ("first-child", None) => nth(0, 1, false, false),
            ("last-child", None) => nth(0, 1, true, false),
            ("first-of-type", None) => nth(0, 1, false, true),
            ("last-of-type", None) => nth(0, 1, true, true),
            ("only-child", None) => only(false),
            ("only-of-type", None) => only(true),
            ("nth-child", _) => counted(false, false)?,
            ("nth-last-child", _) => counted(true, false)?,
            ("nth-of-type", _) => counted(false, true)?,
            ("nth-last-of-type", _) => counted(true, true)?,
            ("root", None) => Test::Root,
            ("empty", None) => Test::Empty,
            ("link" | "any-link", None) => Test::Link,
            ("defined", None) => Test::NoneOf(Vec::new()),
            (
                "hover" | "active" | "focus" | "focus-visible" | "focus-within" | "visited"
                | "target" | "checked" | "disabled" | "enabled" | "before" | "after" | "first-line"
                | "first-letter",
                None,
            ) => Test::Never,
            _ => return None,
        })
    }
}

/// First and last at once.
fn only(of_type: bool) -> Test {
    let end = |from_end| Selector {
        parts: vec![(
            Combinator::Descendant,
            vec![Test::Nth {
                step: 0,
                first: 1,
                from_end,
                of_type,
            }],
        )],
        specificity: [0; 3],
    };
    let not = |from_end| Selector {
        parts: vec![(
            Combinator::Descendant,
            vec![Test::NoneOf(vec![end(from_end)])],
        )],
        specificity: [0; 3],
    };
    Test::NoneOf(vec![not(false), not(true)])
}

/// Reads `2n + 1`, `odd`, `even`, `-n+3`, `4`.
fn an_plus_b(text: &str) -> Option<(i64, i64)> {
    let text: String = text.to_ascii_lowercase().split_ascii_whitespace().collect();
    match text.as_str() {
        "odd" => return Some((2, 1)),
        "even" => return Some((2, 0)),
        _ => {}
    }
    let within = |v: i64| v.abs() <= 1 << 40;
    let Some((step, first)) = text.split_once('n') else {
        return text
            .parse()
            .ok()
            .filter(|&v| within(v))
            .map(|first| (0, first));
    };
    let step: i64 = match step {
        "" | "+" => 1,
        "-" => -1,
        step => step.parse().ok()?,
    };
    let first: i64 = if first.is_empty() {
        0
    } else {
        first.parse().ok()?
    };
    (within(step) && within(first)).then_some((step, first))
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    const TEXT: &str = "<svg><g id='a' class='x y'><rect/><circle/><circle fill='Red-1'/></g>\
         <g id='b'><a href='#'><path/></a><circle id='c1'/></g><rect/></svg>";

    /// The elements that a selector is for, by their places in the document.
    fn found(selector: &str) -> Vec<usize> {
        let document = roxmltree::Document::parse(TEXT).unwrap();
        let (places, list) = (Places::of(&document), selectors(selector).unwrap());
        let elements = document.descendants().filter(Node::is_element).enumerate();
        elements
            .filter(|(_, n)| list.iter().any(|s| s.matches(*n, &places)))
            .map(|(i, _)| i)
            .collect()
    }

    // svg 0, g#a 1, rect 2, circle 3, circle 4, g#b 5, a 6, path 7, circle 8, rect 9.
    #[test]
    fn selectors_match_as_in_browsers() {
        for (selector, wanted) in [
            ("circle", vec![3, 4, 8]),
            ("*", (0..10).collect()),
            ("svg|rect", vec![2, 9]),
            (".x.y > *, #c1", vec![2, 3, 4, 8]),
            (".X", vec![]),
            ("g circle", vec![3, 4, 8]),
            ("svg > circle", vec![]),
            ("rect + circle", vec![3]),
            ("rect ~ circle", vec![3, 4]),
            ("g ~ g path", vec![7]),
            ("circle:nth-child(3)", vec![4]),
            ("circle:nth-of-type(2n + 1)", vec![3, 8]),
            ("#a > :nth-child(odd)", vec![2, 4]),
            ("#a > :nth-child(-n+2)", vec![2, 3]),
            ("g > :last-child", vec![4, 8]),
            ("#b :only-child", vec![7]),
            ("#a :only-of-type", vec![2]),
            (":root > :not(g)", vec![9]),
            ("g:is(#a, #z) > circle:first-of-type", vec![3]),
            ("[fill]", vec![4]),
            ("[fill^=Red]", vec![4]),
            ("[fill='red-1' i]", vec![4]),
            ("[fill|=Red]", vec![4]),
            ("[class~=y]", vec![1]),
            ("[href$='#']", vec![6]),
            (":link", vec![6]),
            ("circle:hover, rect::selection", vec![]),
            ("path:empty", vec![7]),
            ("#\\63 1", vec![8]),
        ] {
            assert_eq!(found(selector), wanted, "{selector}");
        }
    }

    #[test]
    fn the_rest_is_not_read() {
        for text in [
            "g:has(rect)",
            "&:hover",
            "a >",
            "> a",
            "",
            "a,",
            ":nth-child(2 of g)",
            "a[b",
            "1",
        ] {
            let list = selectors(text);
            assert!(text == "1" || list.is_none(), "{text}: {list:?}");
        }
        let deep = ":is(".repeat(1000) + "a" + &")".repeat(1000);
        assert!(selectors(&deep).is_none());
    }

    #[test]
    fn specificity_counts() {
        let of = |text| selectors(text).unwrap()[0].specificity;
        assert_eq!(of("g#a.b[c]:hover rect"), [1, 3, 2]);
        assert_eq!(of(":where(#a) :not(#b, c)"), [1, 0, 0]);
    }

    #[test]
    fn many_descendants_take_no_time() {
        let text = "<g>".repeat(200) + "<rect/>" + &"</g>".repeat(200);
        let document = roxmltree::Document::parse(&text).unwrap();
        let places = Places::of(&document);
        let list = selectors(&("x ".to_owned() + &"g ".repeat(20) + "rect")).unwrap();
        let rect = document
            .descendants()
            .find(|n| n.has_tag_name("rect"))
            .unwrap();
        assert!(!list[0].matches(rect, &places));
    }
}
