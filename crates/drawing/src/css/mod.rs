//! Style sheets: rules, and the conditions of their media.

pub(crate) mod cascade;
pub(crate) mod custom;
pub(crate) mod selector;

use crate::css::selector::{Selector, selectors};
use crate::element::{SVG, is_in};
use crate::notes::{Notes, line_at, line_starts};
use cssparser::{Parser, Token};

/// Rules and `@media` may be nested this deep.
const MOST_NESTED: usize = 32;

/// A property's value, from an attribute, a `style` attribute or a rule.
#[derive(Clone, Debug)]
pub(crate) struct Declaration {
    /// In small letters, except for custom properties.
    pub name: String,
    pub value: String,
    pub important: bool,
    /// Of CSS, not of an attribute.
    pub css: bool,
}

#[derive(Debug, Default)]
pub(crate) struct Rule {
    pub selectors: Vec<Selector>,
    pub declarations: Vec<Declaration>,
    /// Line of the document.
    pub line: u32,
    /// The selector or condition that is not read. Without selectors it may be for any element.
    pub unread: Option<String>,
}

/// Properties that browsers read with the prefix `-webkit-`, too.
const PREFIXED: &str = "transform transform-origin clip-path filter opacity animation animation-name mask mask-image \
    mask-box-image";
/// Parts of conditions of media that hold, and those that do not.
const HOLDS: &str = "all screen (prefers-color-scheme:light) (prefers-reduced-motion:no-preference) \
    (prefers-contrast:no-preference) (forced-colors:none)";
const FAILS: &str = "print speech tty tv projection handheld braille embossed aural (prefers-color-scheme:dark) \
    (prefers-reduced-motion:reduce) (prefers-reduced-motion) (forced-colors:active)";

/// Reads the declarations of a `style` attribute or of a rule.
pub(crate) fn declarations(text: &str) -> Vec<Declaration> {
    let text = without_comments(text);
    let mut found = Vec::new();
    for part in parts(&text, ';') {
        let Some((name, value)) = part.split_once(':') else {
            continue;
        };
        let mut input = Parser::new(name);
        let name = input.expect_ident_cloned();
        let name = match name.and_then(|name| input.expect_exhausted().map(|()| name)) {
            Ok(custom) if custom.starts_with("--") => custom.to_string(),
            Ok(name) => name.to_ascii_lowercase(),
            Err(_) => continue,
        };
        let plain = name.strip_prefix("-webkit-");
        let name = plain.filter(|p| is_in(PREFIXED, p)).unwrap_or(&name);
        // Ends of lines are attributes alone.
        if matches!(name, "x1" | "x2" | "y1" | "y2") {
            continue;
        }
        let value = value.trim();
        let (value, important) = match value.rsplit_once('!') {
            Some((value, word)) if word.trim().eq_ignore_ascii_case("important") => {
                (value.trim_end(), true)
            }
            _ => (value, false),
        };
        found.push(Declaration {
            name: name.to_owned(),
            value: value.to_owned(),
            important,
            css: true,
        });
    }
    found
}

/// Reads a style sheet whose first line is `line` of the document.
pub(crate) fn sheet(text: &str, line: u32, notes: &mut Notes) -> Vec<Rule> {
    let text = without_comments(text)
        .replace("<!--", "    ")
        .replace("-->", "   ");
    let mut sheet = Sheet {
        text: &text,
        starts: line_starts(&text),
        line,
        notes,
        rules: Vec::new(),
    };
    sheet.rules(&text, Context::default());
    sheet.rules
}

struct Sheet<'a> {
    text: &'a str,
    /// Where the lines of the text begin.
    starts: Vec<usize>,
    line: u32,
    notes: &'a mut Notes,
    rules: Vec<Rule>,
}

/// What a rule is within.
#[derive(Clone, Copy, Default)]
struct Context<'a> {
    /// The selectors of the rule about a nested one.
    parent: Option<&'a str>,
    /// The condition that is not read.
    unread: Option<&'a str>,
    depth: usize,
}

impl Sheet<'_> {
    /// The line of the document at which a part of the sheet begins.
    fn line_of(&self, part: &str) -> u32 {
        let offset = (part.as_ptr() as usize).saturating_sub(self.text.as_ptr() as usize);
        self.line - 1 + line_at(&self.starts, offset)
    }

    /// Reads rules, and within a rule its declarations.
    fn rules(&mut self, text: &str, within: Context) {
        let mut rest = text.trim_start();
        while !rest.is_empty() {
            let stops: &[char] = match within.parent.is_some() || rest.starts_with('@') {
                true => &[';', '{'],
                false => &['{'],
            };
            let (head, stop, after) = until(rest, stops);
            let (block, after) = match stop {
                Some('{') => {
                    let (block, _, after) = until(after, &['}']);
                    (Some(block), after)
                }
                _ => (None, after),
            };
            if let Some(at_rule) = head.strip_prefix('@') {
                self.at_rule(at_rule.trim(), head, block, within);
            } else if let Some(parent) = within.parent
                && (block.is_none() || head.starts_with("--"))
            {
                let own = &rest[..rest.len() - after.len()];
                if !head.is_empty() {
                    self.add(parent, own, own, within);
                }
            } else if let Some(block) = block {
                self.rule(head, block, within);
            }
            rest = after.trim_start();
        }
    }

    fn rule(&mut self, head: &str, block: &str, within: Context) {
        if within.depth >= MOST_NESTED {
            return self.refuse(&one_line(head), head);
        }
        let own = match within.parent {
            Some(parent) => nested(head, parent),
            None => head.to_owned(),
        };
        if !block.contains('{') {
            return self.add(&own, head, block, within);
        }
        let inner = Context {
            parent: Some(&own),
            depth: within.depth + 1,
            ..within
        };
        self.rules(block, inner);
    }

    fn add(&mut self, selector: &str, at: &str, block: &str, within: Context) {
        let read = selectors(selector);
        let unread = match &read {
            None => Some(one_line(selector)),
            Some(_) => within.unread.map(str::to_owned),
        };
        self.rules.push(Rule {
            unread,
            selectors: read.unwrap_or_default(),
            declarations: declarations(block),
            line: self.line_of(at),
        });
    }

    /// Adds a rule that refuses every element.
    fn refuse(&mut self, name: &str, at: &str) {
        self.rules.push(Rule {
            declarations: declarations("--any:0"),
            unread: Some(name.to_owned()),
            line: self.line_of(at),
            ..Rule::default()
        });
    }

    fn at_rule(&mut self, text: &str, head: &str, block: Option<&str>, within: Context) {
        let name_end = text.find(|c: char| !(c.is_alphanumeric() || c == '-'));
        let (name, condition) = text.split_at(name_end.unwrap_or(text.len()));
        let name = name.to_ascii_lowercase();
        let own = format!("@{}", one_line(text));
        let applies = match name.as_str() {
            "import" => {
                let line = self.line_of(head);
                return self.notes.warn(format!(
                    "the drawing has @import (line {line}), which is not read; copy the rules into the drawing"
                ));
            }
            "namespace" if condition.contains(SVG) => return,
            "namespace" | "property" => return self.refuse(&own, head),
            "media" => media(condition),
            "supports" | "layer" | "container" | "scope" | "document" | "starting-style" => None,
            _ => return,
        };
        let (Some(block), true) = (block, applies != Some(false)) else {
            return;
        };
        if within.depth >= MOST_NESTED {
            return self.refuse(&own, head);
        }
        let inner = Context {
            unread: applies.map_or(Some(own.as_str()), |_| within.unread),
            depth: within.depth + 1,
            ..within
        };
        self.rules(block, inner);
    }
}

/// The selectors of a rule within the rule of `parent`.
fn nested(head: &str, parent: &str) -> String {
    let parent = format!(":is({})", parent.trim());
    match head.contains('&') {
        true => head.replace('&', &parent),
        false => {
            let own = |part: &str| format!("{parent} {}", part.trim());
            parts(head, ',').map(own).collect::<Vec<_>>().join(",")
        }
    }
}

/// Returns true if a condition of media holds for a still picture on a light screen, `None` for
/// one that is not read.
pub(crate) fn media(condition: &str) -> Option<bool> {
    let condition = condition.trim().to_ascii_lowercase();
    if condition.is_empty() {
        return Some(true);
    }
    let mut result = Some(false);
    for query in condition.split(',') {
        let query = query.trim();
        let (negated, query) = match query.strip_prefix("not ") {
            Some(query) => (true, query),
            None => (false, query.strip_prefix("only ").unwrap_or(query)),
        };
        let parts = query.split(" and ").map(|part| {
            let part: String = part.split_ascii_whitespace().collect();
            let holds = is_in(HOLDS, &part);
            (holds || is_in(FAILS, &part)).then_some(holds)
        });
        let parts: Vec<Option<bool>> = parts.collect();
        let holds = match parts.contains(&Some(false)) {
            true => Some(false),
            false => parts.iter().all(Option::is_some).then_some(true),
        };
        match holds.map(|h| h != negated) {
            Some(true) => return Some(true),
            Some(false) => {}
            None => result = None,
        }
    }
    result
}

/// Text without line ends and double blanks, cut after 60 letters.
pub(crate) fn one_line(text: &str) -> String {
    let words: Vec<&str> = text.split_whitespace().collect();
    let line = words.join(" ");
    match line.char_indices().nth(60) {
        Some((end, _)) => format!("{}...", &line[..end]),
        None => line,
    }
}

/// The parts of a text that `stop` separates outside of quotes and brackets.
fn parts(text: &str, stop: char) -> impl Iterator<Item = &str> {
    let mut rest = Some(text);
    std::iter::from_fn(move || {
        let (part, found, after) = until(rest?, &[stop]);
        rest = found.map(|_| after);
        Some(part)
    })
}

/// Splits at the first of `stops` outside of quotes and brackets: the text before it, the letter,
/// the text after it.
fn until<'a>(text: &'a str, stops: &[char]) -> (&'a str, Option<char>, &'a str) {
    let mut input = Parser::new(text);
    loop {
        let stop = match input.next_including_whitespace() {
            Ok(Token::Semicolon) => ';',
            Ok(Token::Comma) => ',',
            Ok(Token::CurlyBracketBlock) => '{',
            Ok(Token::CloseCurlyBracket) => '}',
            Ok(_) => continue,
            Err(_) => return (text, None, ""),
        };
        if stops.contains(&stop) {
            let after = input.position().byte_index();
            return (&text[..after - 1], Some(stop), &text[after..]);
        }
    }
}

/// Comments become blanks, their line ends stay.
pub(crate) fn without_comments(text: &str) -> String {
    let mut out = String::with_capacity(text.len());
    let mut rest = text;
    while let Some(at) = rest.find(['"', '\'', '/']) {
        let (before, found) = rest.split_at(at);
        out.push_str(before);
        let comment = found.strip_prefix("/*");
        rest = match comment {
            Some(comment) => {
                let (comment, after) = comment.split_once("*/").unwrap_or((comment, ""));
                out.push(' ');
                out.extend(comment.chars().filter(|&c| c == '\n'));
                after
            }
            None => {
                let length = string_length(found);
                out.push_str(&found[..length]);
                &found[length..]
            }
        };
    }
    out.push_str(rest);
    out
}

/// Length of the string that a text begins with, to the end of its line at most; 1 for another
/// letter.
fn string_length(text: &str) -> usize {
    let mut letters = text.char_indices();
    let quote = letters.next().map(|(_, c)| c).filter(|c| *c != '/');
    while let (Some(quote), Some((i, c))) = (quote, letters.next()) {
        match c {
            '\\' => drop(letters.next()),
            '\n' => return i,
            c if c == quote => return i + 1,
            _ => {}
        }
    }
    quote.map_or(1, |_| text.len())
}
