#![allow(clippy::unwrap_used)]
use super::*;

const TEXT: &str = "<svg><g id='a' class='x y'><rect/><circle/><circle fill='Red-1'/></g>\
     <g id='b'><a href='#'><path/></a><circle id='c1'/></g><rect/></svg>";

/// The elements that a selector is for, by their places in the document.
fn found(selector: &str) -> Vec<usize> {
    let document = roxmltree::Document::parse(TEXT).unwrap();
    let (matcher, list) = (Matcher::default(), selectors(selector).unwrap());
    let elements = document.descendants().filter(Node::is_element).enumerate();
    elements
        .filter(|(_, n)| list.iter().any(|s| matcher.matches(s, *n)))
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
[fill => 4
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
    let texts = "g:has(rect)|&:hover|a >|> a||a,|:nth-child(2 of g)|a:first|a:root-child";
    for text in texts.split('|').chain([&*deep]) {
        let list = selectors(text);
        assert!(list.is_none(), "{text}: {list:?}");
    }
}
