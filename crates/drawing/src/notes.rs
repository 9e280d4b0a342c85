//! Warnings of a drawing, and its refusals with the line of the element.

use crate::fault::Fault;
use std::collections::HashSet;

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
    pub fn line(&self, node: roxmltree::Node) -> u32 {
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
    pub fn warn_at(&mut self, node: roxmltree::Node, what: &str, how: &str) {
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

/// The refusal of `what`, and why. It reads the document for the line of the element.
pub(crate) fn misled(node: roxmltree::Node, what: &str, how: &str) -> Fault {
    let line = node.document().text_pos_at(node.range().start).row;
    Fault::new(format!("the drawing has {what} (line {line}), {how}"))
}

/// The refusal of a feature that has no outline.
pub(crate) fn unsupported(node: roxmltree::Node, what: &str, remedy: &str) -> Fault {
    let Fault(text) = misled(node, what, &format!("which has no outline here; {remedy}"));
    Fault(text.replacen("has", "uses", 1))
}
