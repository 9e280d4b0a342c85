//! Elements of XML: namespaces, attributes, references, conditions.

use roxmltree::Node;

pub(crate) const SVG: &str = "http://www.w3.org/2000/svg";
const XLINK: &str = "http://www.w3.org/1999/xlink";
pub(crate) const XHTML: &str = "http://www.w3.org/1999/xhtml";

/// An attribute of SVG: those of other namespaces do not count.
pub(crate) fn attribute<'n>(node: Node<'n, '_>, name: &str) -> Option<&'n str> {
    let mut own = node.attributes();
    let found = own.find(|a| a.namespace().is_none() && a.name() == name);
    found.map(|a| a.value())
}

/// The address of a reference, without blanks around it; `None` for an empty one.
pub(crate) fn href<'n>(node: Node<'n, '_>) -> Option<&'n str> {
    let address = attribute(node, "href").or_else(|| node.attribute((XLINK, "href")))?;
    Some(address.trim()).filter(|a| !a.is_empty())
}

pub(crate) fn is_svg(node: Node) -> bool {
    node.is_element() && matches!(node.tag_name().namespace(), None | Some(SVG))
}

/// Returns true if the conditions of an element hold in an English browser.
pub(crate) fn passes(node: Node) -> bool {
    let extensions = attribute(node, "requiredExtensions").map_or("", str::trim);
    let languages = attribute(node, "systemLanguage");
    let english = |l: &str| matches!(l.trim().split('-').next(), Some("en" | "EN" | "En"));
    (extensions.is_empty() || extensions == XHTML)
        && languages.is_none_or(|l| l.split(',').any(english))
}

/// Returns true for a word of a list that blanks separate.
pub(crate) fn is_in(list: &str, word: &str) -> bool {
    list.split(' ').any(|known| known == word)
}
