//! Scripts, animations and style sheets of other files, which are not read.

use crate::element::{XHTML, attribute, href, is_svg};
use crate::notes::Notes;
use crate::notes::OTHER_SHEET;
use roxmltree::Node;

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

pub(crate) fn is_motion(name: &str) -> bool {
    name.starts_with("animate") || matches!(name, "set" | "discard" | "script")
}
