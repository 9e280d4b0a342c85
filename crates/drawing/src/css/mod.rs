//! Style sheets: rules, and the conditions of their media.

pub(crate) mod cascade;
pub(crate) mod custom;
pub(crate) mod selector;

use crate::css::selector::{Selector, selectors};
use crate::element::{SVG, is_in};
use crate::notes::Notes;
use cssparser::{
    AtRuleParser, CowRcStr, DeclarationParser, ParseError, Parser, ParserState,
    QualifiedRuleParser, RuleBodyItemParser, RuleBodyParser, StyleSheetParser, Token,
};

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

/// Reads the declarations of a `style` attribute.
pub(crate) fn declarations(text: &str) -> Vec<Declaration> {
    let mut notes = Notes::default();
    let mut sheet = Sheet::new(0, &mut notes);
    sheet.is_attribute = true;
    RuleBodyParser::new(&mut Parser::new(text), &mut sheet).for_each(drop);
    sheet.declarations
}

/// Reads a style sheet whose first line is `line` of the document.
pub(crate) fn sheet(text: &str, line: u32, notes: &mut Notes) -> Vec<Rule> {
    let mut sheet = Sheet::new(line, notes);
    StyleSheetParser::new(&mut Parser::new(text), &mut sheet).for_each(drop);
    sheet.rules
}

struct Sheet<'n> {
    /// The text is that of a `style` attribute.
    is_attribute: bool,
    /// The line of the document on which the text begins.
    line: u32,
    notes: &'n mut Notes,
    rules: Vec<Rule>,
    within: Context,
    /// Those of the rule that is being read, after the last rule within it.
    declarations: Vec<Declaration>,
}

/// What is being read.
#[derive(Clone, Default)]
struct Context {
    /// The selectors of the rule, with those of the rules about it, and its line.
    rule: Option<(String, u32)>,
    /// The condition that is not read.
    unread: Option<String>,
    depth: usize,
}

type Parsed<T = ()> = Result<T, ParseError<()>>;
/// The name of a rule such as `@media`, and what follows it.
type Head = (String, String);

impl<'n> Sheet<'n> {
    fn new(line: u32, notes: &'n mut Notes) -> Self {
        Self {
            is_attribute: false,
            line,
            notes,
            rules: Vec::new(),
            within: Context::default(),
            declarations: Vec::new(),
        }
    }

    fn line_of(&self, start: &ParserState) -> u32 {
        self.line + start.source_location().line
    }

    /// Reads a block within a rule or a condition. `own`: the text before it.
    fn block<'i>(&mut self, own: &str, line: u32, mut inner: Context, input: &mut Parser<'i>) {
        if inner.depth >= MOST_NESTED {
            return self.refuse(one_line(own), line);
        }
        inner.depth += 1;
        self.finish();
        let outer = std::mem::replace(&mut self.within, inner);
        RuleBodyParser::new(input, self).for_each(drop);
        self.finish();
        self.within = outer;
    }

    /// Adds a rule of the declarations so far.
    fn finish(&mut self) {
        let declarations = std::mem::take(&mut self.declarations);
        let Some((text, line)) = self
            .within
            .rule
            .as_ref()
            .filter(|_| !declarations.is_empty())
        else {
            return;
        };
        let read = selectors(text);
        let unread = match &read {
            None => Some(one_line(text)),
            Some(_) => self.within.unread.clone(),
        };
        self.rules.push(Rule {
            unread,
            selectors: read.unwrap_or_default(),
            declarations,
            line: *line,
        });
    }

    /// Adds a rule that refuses every element.
    fn refuse(&mut self, name: String, line: u32) {
        self.rules.push(Rule {
            declarations: declarations("--any:0"),
            unread: Some(name),
            line,
            ..Rule::default()
        });
    }

    fn at_rule(&mut self, (name, condition): Head, line: u32, block: Option<&mut Parser>) {
        let own = one_line(&format!("@{name}{condition}"));
        let applies = match name.to_ascii_lowercase().as_str() {
            "import" => {
                return self.notes.warn(format!(
                    "the drawing has @import (line {line}), which is not read; copy the rules into the drawing"
                ));
            }
            "namespace" if condition.contains(SVG) => return,
            "namespace" | "property" => return self.refuse(own, line),
            "media" => media(&condition),
            "supports" | "layer" | "container" | "scope" | "document" | "starting-style" => None,
            _ => return,
        };
        if let Some(block) = block.filter(|_| applies != Some(false)) {
            let mut inner = self.within.clone();
            if applies.is_none() {
                inner.unread = Some(own.clone());
            }
            self.block(&own, line, inner, block);
        }
    }
}

impl<'i> DeclarationParser<'i> for Sheet<'_> {
    type Declaration = ();
    type Error = ();

    fn parse_value(
        &mut self,
        name: CowRcStr<'i>,
        input: &mut Parser<'i>,
        _: &ParserState,
    ) -> Parsed {
        let mut value = String::new();
        let has_block = add_plain(input, &mut value);
        let name = match name.starts_with("--") {
            true => name.to_string(),
            // It is the rule of a selector such as `a:hover`.
            false if has_block && !self.is_attribute => return Err(ParseError::unexpected_token()),
            false => name.to_ascii_lowercase(),
        };
        let plain = name.strip_prefix("-webkit-");
        let name = plain.filter(|p| is_in(PREFIXED, p)).unwrap_or(&name);
        let value = value.trim();
        let (value, important) = match value.rsplit_once('!') {
            Some((value, word)) if word.trim().eq_ignore_ascii_case("important") => {
                (value.trim_end(), true)
            }
            _ => (value, false),
        };
        // Ends of lines are attributes alone.
        if !matches!(name, "x1" | "x2" | "y1" | "y2") {
            self.declarations.push(Declaration {
                name: name.to_owned(),
                value: value.to_owned(),
                important,
                css: true,
            });
        }
        Ok(())
    }
}

impl<'i> QualifiedRuleParser<'i> for Sheet<'_> {
    type Prelude = String;
    type QualifiedRule = ();
    type Error = ();

    fn parse_prelude(&mut self, input: &mut Parser<'i>) -> Parsed<String> {
        Ok(plain(input))
    }

    fn parse_block(&mut self, head: String, start: &ParserState, input: &mut Parser<'i>) -> Parsed {
        let line = self.line_of(start);
        let mut inner = self.within.clone();
        let selectors = match &inner.rule {
            Some((parent, _)) => nested(&head, parent),
            None => head.trim().to_owned(),
        };
        inner.rule = Some((selectors, line));
        self.block(&head, line, inner, input);
        Ok(())
    }
}

impl<'i> AtRuleParser<'i> for Sheet<'_> {
    type Prelude = Head;
    type AtRule = ();
    type Error = ();

    fn parse_prelude(&mut self, name: CowRcStr<'i>, input: &mut Parser<'i>) -> Parsed<Head> {
        Ok((name.to_string(), plain(input)))
    }

    fn rule_without_block(&mut self, prelude: Head, start: &ParserState) -> Result<(), ()> {
        self.at_rule(prelude, self.line_of(start), None);
        Ok(())
    }

    fn parse_block(
        &mut self,
        prelude: Head,
        start: &ParserState,
        input: &mut Parser<'i>,
    ) -> Parsed {
        self.at_rule(prelude, self.line_of(start), Some(input));
        Ok(())
    }
}

impl RuleBodyItemParser<'_, (), ()> for Sheet<'_> {
    fn parse_declarations(&self) -> bool {
        self.is_attribute || self.within.rule.is_some()
    }

    fn parse_qualified(&self) -> bool {
        !self.is_attribute
    }
}

/// The selectors of a rule within the rule of `parent`.
fn nested(head: &str, parent: &str) -> String {
    let parent = format!(":is({parent})");
    if head.contains('&') {
        return head.replace('&', &parent);
    }
    let mut input = Parser::new(head);
    let own =
        |input: &mut Parser| -> Parsed<String> { Ok(format!("{parent} {}", plain(input).trim())) };
    input
        .parse_comma_separated(own)
        .unwrap_or_default()
        .join(",")
}

/// The text that is left, without comments.
pub(crate) fn plain(input: &mut Parser) -> String {
    let mut text = String::new();
    add_plain(input, &mut text);
    text
}

/// Adds the text that is left. Comments become blanks, and blocks without an end get one. Returns
/// true if a part of it is in braces.
fn add_plain(input: &mut Parser, text: &mut String) -> bool {
    let mut has_block = false;
    loop {
        let start = input.position();
        let end = match input.next_including_whitespace_and_comments() {
            Err(_) => return has_block,
            Ok(Token::Comment(_)) => {
                text.push(' ');
                continue;
            }
            Ok(Token::Function(_) | Token::ParenthesisBlock) => Some(')'),
            Ok(Token::SquareBracketBlock) => Some(']'),
            Ok(Token::CurlyBracketBlock) => Some('}'),
            Ok(_) => None,
        };
        text.push_str(input.slice_from(start));
        if let Some(end) = end {
            has_block |= end == '}';
            let _: Parsed<bool> = input.parse_nested_block(|inner| Ok(add_plain(inner, text)));
            text.push(end);
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
