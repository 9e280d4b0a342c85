//! Warnings of a drawing, and its refusals with the line of the element.

use crate::element::{XHTML, attribute, href, is_svg};
use roxmltree::Node;
use std::collections::HashSet;
use std::fmt::{Display, Formatter};

/// Most warnings of one drawing.
const MOST: usize = 12;

/// The warning about style sheets of other files.
pub(crate) const OTHER_SHEET: &str = "the drawing has a style sheet in another file, which is not read; copy the rules into the drawing";

/// The warnings so far, each once.
#[derive(Debug, Default)]
pub(crate) struct Notes {
    warnings: Vec<String>,
    /// What is said without its line.
    known: HashSet<String>,
    /// Where the lines of the document begin, after the first.
    starts: Vec<usize>,
}

impl Notes {
    pub fn of(document: &roxmltree::Document) -> Self {
        let ends = document.input_text().match_indices('\n');
        Self {
            starts: ends.map(|(i, _)| i + 1).collect(),
            ..Self::default()
        }
    }

    /// The line of the document on which an element begins.
    pub fn line(&self, node: Node) -> u32 {
        let place = node.range().start;
        1 + self.starts.partition_point(|&start| start <= place) as u32
    }

    /// Adds a warning. Those that differ only in the line are given once.
    pub fn warn(&mut self, text: String) {
        let mut key = text.clone();
        if let Some((before, after)) = text.split_once("(line ") {
            key = format!(
                "{before}{}",
                after.trim_start_matches(|c: char| c.is_ascii_digit())
            );
        }
        if self.known.insert(key) {
            self.warnings.push(text);
        }
    }

    /// Warns of a feature of an element: `what`, its line, and `how` it is drawn.
    pub fn warn_at(&mut self, node: Node, what: &str, how: &str) {
        self.warn(format!(
            "the drawing has {what} (line {}){how}",
            self.line(node)
        ));
    }

    pub fn into_warnings(mut self) -> Vec<String> {
        if self.warnings.len() > MOST {
            let more = self.warnings.len() - MOST;
            self.warnings.truncate(MOST);
            self.warnings
                .push(format!("the drawing has {more} more such features"));
        }
        self.warnings
    }
}

/// Why a drawing is refused, in one line: the feature, its line in the file and a remedy.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Fault(pub(crate) String);

/// A value, or why the drawing is refused.
pub type Result<T> = std::result::Result<T, Fault>;

impl Fault {
    pub(crate) fn new(text: impl Into<String>) -> Self {
        Self(text.into())
    }

    /// The fault of a file that cannot be parsed.
    pub(crate) fn damaged(e: &dyn Display) -> Self {
        let text = e.to_string().replace('\n', " ");
        Self(format!(
            "the drawing is damaged ({text}); save it again as plain SVG"
        ))
    }
}

impl Display for Fault {
    fn fmt(&self, f: &mut Formatter) -> std::fmt::Result {
        f.write_str(&self.0)
    }
}

impl std::error::Error for Fault {}

/// The refusal of `what`, and why. It reads the document for the line of the element.
pub(crate) fn misled(node: Node, what: &str, how: &str) -> Fault {
    let line = node.document().text_pos_at(node.range().start).row;
    Fault::new(format!("the drawing has {what} (line {line}), {how}"))
}

/// The refusal of a feature that has no outline.
pub(crate) fn unsupported(node: Node, what: &str, remedy: &str) -> Fault {
    let Fault(text) = misled(node, what, &format!("which has no outline here; {remedy}"));
    Fault(text.replacen("has", "uses", 1))
}

/// Warns of what moves the drawing or is in another file, wherever it is.
pub(crate) fn warn_of_motion(node: Node, notes: &mut Notes) {
    let name = node.tag_name().name();
    let is_html = node.tag_name().namespace() == Some(XHTML);
    if name == "link" && is_html && attribute(node, "rel") == Some("stylesheet") {
        return notes.warn(OTHER_SHEET.to_owned());
    }
    let rest = match name {
        "script" if (is_svg(node) || is_html) && runs(node) => "a script, which is not run",
        _ if !is_svg(node) => return,
        _ if is_motion(name) => "an animation, which is drawn at rest",
        _ if attribute(node, "onload").is_some() => "a script on loading, which is not run",
        _ => return,
    };
    notes.warn_at(node, &format!("<{name}>"), &format!(": {rest}"));
}

fn runs(script: Node) -> bool {
    let has_text = script.text().is_some_and(|t| !t.trim().is_empty());
    has_text || href(script).is_some() || attribute(script, "src").is_some()
}

/// Returns true for elements that move others, or that run.
pub(crate) fn is_motion(name: &str) -> bool {
    name.starts_with("animate") || matches!(name, "set" | "discard" | "script")
}
