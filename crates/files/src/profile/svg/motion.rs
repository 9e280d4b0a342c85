//! Scripts, animations and style sheets of other files, which are not read.

use super::notes::Notes;
use super::reader::{XHTML, href, is_svg};
use super::value::attribute;
use roxmltree::Node;

/// The warning about style sheets of other files.
pub(super) const OTHER_SHEET: &str = "the drawing has a style sheet in another file, which is not read; copy the rules into the drawing";

/// Warns of what moves the drawing or is in another file, wherever it is.
pub(super) fn warn_of_motion(node: Node, notes: &mut Notes) {
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

pub(super) fn is_motion(name: &str) -> bool {
    name.starts_with("animate") || matches!(name, "set" | "discard" | "script")
}
