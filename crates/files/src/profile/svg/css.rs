//! Style sheets: rules, and the conditions of their media.

use super::notes::Notes;
use super::selector::{Selector, selectors};

/// `@media` within `@media` may be nested this deep.
const MOST_NESTED: usize = 8;

/// A property's value, from an attribute, a `style` attribute or a rule.
#[derive(Clone, Debug)]
pub(super) struct Declaration {
    /// In small letters, except for custom properties.
    pub name: String,
    pub value: String,
    pub important: bool,
    /// Of CSS, not of an attribute.
    pub css: bool,
}

#[derive(Debug, Default)]
pub(super) struct Rule {
    pub selectors: Vec<Selector>,
    pub declarations: Vec<Declaration>,
    /// Line of the document.
    pub line: u32,
    /// The selector or condition that is not read. Without selectors it may be for any element.
    pub unread: Option<String>,
}

/// Reads the declarations of a `style` attribute or of a rule.
pub(super) fn declarations(text: &str) -> Vec<Declaration> {
    let text = without_comments(text);
    let mut rest = text.as_str();
    let mut found = Vec::new();
    while !rest.is_empty() {
        let (part, _, after) = until(rest, &[';']);
        rest = after;
        let Some((name, value)) = part.split_once(':') else {
            continue;
        };
        let name = match name.trim() {
            custom if custom.starts_with("--") => custom.to_owned(),
            name => name.to_ascii_lowercase(),
        };
        let value = value.trim();
        let (value, important) = match value.rsplit_once('!') {
            Some((value, word)) if word.trim().eq_ignore_ascii_case("important") => {
                (value.trim_end(), true)
            }
            _ => (value, false),
        };
        found.push(Declaration {
            name,
            value: value.to_owned(),
            important,
            css: true,
        });
    }
    found
}

/// Reads a style sheet whose first line is `line` of the document.
pub(super) fn sheet(text: &str, line: u32, notes: &mut Notes) -> Vec<Rule> {
    let text = without_comments(text)
        .replace("<!--", "    ")
        .replace("-->", "   ");
    let mut rules = Vec::new();
    Sheet {
        text: &text,
        line,
        notes,
    }
    .rules(&text, None, 0, &mut rules);
    rules
}

struct Sheet<'a> {
    text: &'a str,
    line: u32,
    notes: &'a mut Notes,
}

impl Sheet<'_> {
    /// The line of the document at which a part of the sheet begins.
    fn line_of(&self, part: &str) -> u32 {
        let offset = (part.as_ptr() as usize).saturating_sub(self.text.as_ptr() as usize);
        let before = self.text.as_bytes().get(..offset).unwrap_or_default();
        self.line + before.iter().filter(|&&b| b == b'\n').count() as u32
    }

    fn rules(&mut self, text: &str, unread: Option<&str>, depth: usize, rules: &mut Vec<Rule>) {
        let mut rest = text.trim_start();
        while !rest.is_empty() {
            let stops: &[char] = if rest.starts_with('@') {
                &[';', '{']
            } else {
                &['{']
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
                self.at_rule(at_rule.trim(), head, block, unread, depth, rules);
            } else if let Some(block) = block {
                rules.push(self.rule(head, block, unread));
            }
            rest = after.trim_start();
        }
    }

    fn rule(&self, head: &str, block: &str, unread: Option<&str>) -> Rule {
        let read = selectors(head);
        let nested = block
            .contains('{')
            .then(|| format!("{} {{ ... {{", one_line(head)));
        Rule {
            unread: match &read {
                None => Some(one_line(head)),
                Some(_) => nested.or_else(|| unread.map(str::to_owned)),
            },
            selectors: read.unwrap_or_default(),
            declarations: declarations(block),
            line: self.line_of(head),
        }
    }

    fn at_rule(
        &mut self,
        text: &str,
        head: &str,
        block: Option<&str>,
        unread: Option<&str>,
        depth: usize,
        rules: &mut Vec<Rule>,
    ) {
        let name_end = text.find(|c: char| !(c.is_alphanumeric() || c == '-'));
        let (name, condition) = text.split_at(name_end.unwrap_or(text.len()));
        let name = name.to_ascii_lowercase();
        if name == "import" {
            let line = self.line_of(head);
            self.notes.warn(format!(
                "the drawing has @import (line {line}), which is not read; copy the rules into the drawing"
            ));
            return;
        }
        let conditional = [
            "media",
            "supports",
            "layer",
            "container",
            "scope",
            "document",
        ];
        let (Some(block), true) = (block, conditional.contains(&name.as_str())) else {
            return;
        };
        let applies = match name.as_str() {
            "media" => media(condition),
            _ => None,
        };
        let own = format!("@{}", one_line(text));
        let unread = match applies {
            Some(false) => return,
            Some(true) => unread,
            None => Some(own.as_str()),
        };
        if depth < MOST_NESTED {
            self.rules(block, unread, depth + 1, rules);
        } else {
            let declarations = declarations(block.trim_start_matches(|c| c != '{'));
            let unread = Some(own.clone());
            rules.push(Rule {
                declarations,
                unread,
                ..Rule::default()
            });
        }
    }
}

/// Returns true if a condition of media holds for a still picture on a light screen, `None` for
/// one that is not read.
pub(super) fn media(condition: &str) -> Option<bool> {
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
            match part.as_str() {
                "all"
                | "screen"
                | "(prefers-color-scheme:light)"
                | "(prefers-reduced-motion:no-preference)"
                | "(prefers-contrast:no-preference)"
                | "(forced-colors:none)" => Some(true),
                "print"
                | "speech"
                | "tty"
                | "tv"
                | "projection"
                | "handheld"
                | "braille"
                | "embossed"
                | "aural"
                | "(prefers-color-scheme:dark)"
                | "(prefers-reduced-motion:reduce)"
                | "(prefers-reduced-motion)"
                | "(forced-colors:active)" => Some(false),
                _ => None,
            }
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
pub(super) fn one_line(text: &str) -> String {
    let words: Vec<&str> = text.split_whitespace().collect();
    let line = words.join(" ");
    match line.char_indices().nth(60) {
        Some((end, _)) => format!("{}...", &line[..end]),
        None => line,
    }
}

/// Splits at the first of `stops` outside of quotes and brackets: the text before it, the letter,
/// the text after it.
fn until<'a>(text: &'a str, stops: &[char]) -> (&'a str, Option<char>, &'a str) {
    let (mut open, mut quote): (Vec<char>, Option<char>) = (Vec::new(), None);
    let mut letters = text.char_indices();
    while let Some((i, c)) = letters.next() {
        if c == '\\' {
            letters.next();
        } else if let Some(q) = quote {
            if c == q {
                quote = None;
            }
        } else if open.is_empty() && stops.contains(&c) {
            return (&text[..i], Some(c), &text[i + c.len_utf8()..]);
        } else {
            match c {
                '"' | '\'' => quote = Some(c),
                '(' => open.push(')'),
                '[' => open.push(']'),
                '{' => open.push('}'),
                _ if open.last() == Some(&c) => drop(open.pop()),
                _ => {}
            }
        }
    }
    (text, None, "")
}

/// Comments become blanks, their line ends stay.
fn without_comments(text: &str) -> String {
    let mut out = String::with_capacity(text.len());
    let mut rest = text;
    while let Some((before, after)) = rest.split_once("/*") {
        out.push_str(before);
        let (comment, after) = after.split_once("*/").unwrap_or((after, ""));
        out.push(' ');
        out.extend(comment.chars().filter(|&c| c == '\n'));
        rest = after;
    }
    out.push_str(rest);
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    fn names(text: &str) -> Vec<(usize, Vec<String>, Option<String>, u32)> {
        let rules = sheet(text, 10, &mut Notes::default());
        let name = |d: &Declaration| {
            format!(
                "{}={}{}",
                d.name,
                d.value,
                ["", "!"][usize::from(d.important)]
            )
        };
        let of = |r: &Rule| {
            (
                r.selectors.len(),
                r.declarations.iter().map(name).collect(),
                r.unread.clone(),
                r.line,
            )
        };
        rules.iter().map(of).collect()
    }

    #[test]
    fn rules_are_read() {
        let text = "@charset 'a';<!-- .a, .b { Fill: url(a;b) !important; --X:1 } -->/* {\n */\n\
            @font-face { font-family: 'a}' } @media print { a { fill: red } }\n\
            @media screen { c { d: 'x;y' } } e{f:g";
        let got = names(text);
        let own = |list: &[&str]| list.iter().map(|&s| s.to_owned()).collect::<Vec<_>>();
        assert_eq!(got[0], (2, own(&["fill=url(a;b)!", "--X=1"]), None, 10));
        assert_eq!(got[1], (1, own(&["d='x;y'"]), None, 13));
        assert_eq!(got[2], (1, own(&["f=g"]), None, 13));
        assert_eq!(got.len(), 3);
    }

    #[test]
    fn the_rest_is_kept_by_name() {
        assert_eq!(names("a:has(b) {c:d}")[0].2.as_deref(), Some("a:has(b)"));
        assert_eq!(
            names("@supports (x: y) { a {c:d} }")[0].2.as_deref(),
            Some("@supports (x: y)")
        );
        assert_eq!(names("@media (min-width: 9px) { a {c:d} }")[0].0, 1);
        assert!(names("a { b:c; & d { e:f } }")[0].2.is_some());
        let mut notes = Notes::default();
        assert!(sheet("@import 'a.css'; a{b:c}", 1, &mut notes).len() == 1);
        assert!(notes.into_warnings()[0].contains("@import (line 1)"));
    }

    #[test]
    fn conditions_of_media() {
        for (text, wanted) in [
            ("", Some(true)),
            ("screen", Some(true)),
            ("print, screen", Some(true)),
            ("not print", Some(true)),
            ("only screen and (prefers-color-scheme: dark)", Some(false)),
            ("screen and (min-width: 100px)", None),
            ("print and (min-width: 100px)", Some(false)),
        ] {
            assert_eq!(media(text), wanted, "{text}");
        }
    }
}
