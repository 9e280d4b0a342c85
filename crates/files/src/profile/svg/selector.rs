//! Selectors of CSS: which elements a rule is for.

use super::value::attribute;
use roxmltree::{Node, NodeId};
use std::cell::Cell;
use std::collections::{HashMap, HashSet};

/// A selector without commas.
#[derive(Clone, Debug)]
pub(super) struct Selector {
    /// Each with what joins it to the one before it.
    pub parts: Vec<(Combinator, Vec<Test>)>,
    /// Number of ids, of classes and alike, of types.
    pub specificity: [u32; 3],
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Combinator {
    Descendant,
    Child,
    Next,
    Later,
}

#[derive(Clone, Debug)]
pub(super) enum Test {
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
            let elements = || parent.children().filter(Node::is_element);
            for (child, all) in elements().zip(1..) {
                let same = counts.entry(child.tag_name().name()).or_default();
                *same += 1;
                let index = [all, *same];
                places.insert(
                    child.id(),
                    Place {
                        index,
                        ..Place::default()
                    },
                );
            }
            let all = elements().count() as i64;
            for child in elements() {
                if let Some(place) = places.get_mut(&child.id()) {
                    place.count = [all, counts[child.tag_name().name()]];
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

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::super::selector_reader::selectors;
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

    /// svg 0, g#a 1, rect 2, circle 3, circle 4, g#b 5, a 6, path 7, circle 8, rect 9.
    const FOUND: &str = r"
circle => 3 4 8
* => 0 1 2 3 4 5 6 7 8 9
svg|rect => 2 9
.x.y > *, #c1 => 2 3 4 8
.X => 
g circle => 3 4 8
svg > circle => 
rect + circle => 3
rect ~ circle => 3 4
g ~ g path => 7
circle:nth-child(3) => 4
circle:nth-of-type(2n + 1) => 3 8
#a > :nth-child(odd) => 2 4
#a > :nth-child(-n+2) => 2 3
#b > :nth-last-child(2) => 6
g > :last-child => 4 8
#b :only-child => 7
#a :only-of-type => 2
:root > :not(g) => 9
g:is(#a, #z) > circle:first-of-type => 3
[fill] => 4
[fill^=Red] => 4
[fill='red-1' i] => 4
[fill|=Red] => 4
[class~=y] => 1
[href$='#'] => 6
:link => 6
circle:hover, rect::selection => 
path:empty => 7
#\63 1 => 8";

    #[test]
    fn selectors_match_as_in_browsers() {
        for (selector, wanted) in FOUND.lines().filter_map(|line| line.split_once(" => ")) {
            let wanted: Vec<usize> = wanted.split(' ').filter_map(|n| n.parse().ok()).collect();
            assert_eq!(found(selector), wanted, "{selector}");
        }
    }

    #[test]
    fn the_rest_is_not_read() {
        let deep = ":is(".repeat(1000) + "a" + &")".repeat(1000);
        let texts = "g:has(rect)|&:hover|a >|> a||a,|:nth-child(2 of g)|a[b|a:first|a:root-child";
        for text in texts.split('|').chain([&*deep]) {
            let list = selectors(text);
            assert!(list.is_none(), "{text}: {list:?}");
        }
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
        let rect = document.descendants().find(|n| n.has_tag_name("rect"));
        assert!(!list[0].matches(rect.unwrap(), &places));
    }
}
