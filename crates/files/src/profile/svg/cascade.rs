//! The cascade: which declaration of a property counts for an element.

use super::css::{Declaration, Rule, declarations, media, one_line, sheet};
use super::notes::{Notes, line};
use super::selector::Places;
use super::value::Value;
use crate::content_fault;
use revmap::error::Result;
use roxmltree::Node;
use std::collections::HashMap;
use std::rc::Rc;

/// Custom properties of CSS (`--name`), inherited.
pub(super) type Custom = Rc<HashMap<String, String>>;

/// References between custom properties may be nested this deep.
const MOST_NESTED: usize = 16;
/// Longest value after custom properties are filled in, bytes.
const MOST_BYTES: usize = 1 << 16;

/// Importance, then attribute, rule or `style` attribute, then specificity.
type Strength = (bool, u8, [u32; 3]);

/// All style sheets of a drawing.
pub(super) struct Sheets {
    rules: Vec<Rule>,
    places: Places,
}

impl Sheets {
    pub fn of(document: &roxmltree::Document, notes: &mut Notes) -> Self {
        let mut rules = Vec::new();
        for node in document.descendants() {
            if node.pi().is_some_and(|pi| pi.target == "xml-stylesheet") {
                notes.warn(
                    "the drawing has a style sheet in another file, which is not read; copy the rules into the drawing"
                        .to_owned(),
                );
            }
            if !node.is_element() || node.tag_name().name() != "style" {
                continue;
            }
            if !matches!(node.attribute("type"), None | Some("" | "text/css")) {
                continue;
            }
            let condition = node.attribute("media").unwrap_or_default();
            let applies = media(condition);
            if applies == Some(false) {
                continue;
            }
            for text in node.children().filter(|n| n.is_text()) {
                let row = node.document().text_pos_at(text.range().start).row;
                let mut own = sheet(text.text().unwrap_or_default(), row, notes);
                if applies.is_none() {
                    let unread = format!("<style media=\"{}\">", one_line(condition));
                    own.iter_mut().for_each(|r| r.unread = Some(unread.clone()));
                }
                rules.append(&mut own);
            }
        }
        Self {
            rules,
            places: Places::of(document),
        }
    }

    /// The declarations for an element, the strongest first.
    ///
    /// # Errors
    /// If a rule that is not read may be for the element.
    pub fn declared(&self, node: Node) -> Result<Declared> {
        let mut found: Vec<(Strength, Declaration)> = Vec::new();
        for attribute in node.attributes().filter(|a| a.namespace().is_none()) {
            let name = attribute.name();
            if !matches!(name, "style" | "class" | "id") {
                let declaration = Declaration {
                    name: name.to_owned(),
                    value: attribute.value().trim().to_owned(),
                    important: false,
                    css: false,
                };
                found.push(((false, 0, [0; 3]), declaration));
            }
        }
        for rule in &self.rules {
            let matching = rule
                .selectors
                .iter()
                .filter(|s| s.matches(node, &self.places));
            let specificity = matching.map(|s| s.specificity).max();
            if let Some(unread) = &rule.unread {
                let may_match = specificity.is_some() || rule.selectors.is_empty();
                if may_match && rule.declarations.iter().any(|d| counts(&d.name)) {
                    return Err(content_fault(format!(
                        "the drawing has the rule \"{unread}\" (line {}), which is not read; \
                         give the elements their properties directly",
                        rule.line
                    )));
                }
            } else if let Some(specificity) = specificity {
                for d in &rule.declarations {
                    found.push(((d.important, 1, specificity), d.clone()));
                }
            }
        }
        for d in declarations(node.attribute("style").unwrap_or_default()) {
            found.push(((d.important, 2, [0; 3]), d));
        }
        // A stable sort keeps the order of the document among equals.
        found.sort_by_key(|(strength, _)| *strength);
        let mut map: HashMap<String, Vec<Declaration>> = HashMap::new();
        for (_, d) in found.into_iter().rev() {
            if d.name == "marker" && d.css {
                for name in ["marker-start", "marker-mid", "marker-end"] {
                    map.entry(name.to_owned()).or_default().push(d.clone());
                }
            } else {
                map.entry(d.name.clone()).or_default().push(d);
            }
        }
        Ok(Declared(map))
    }
}

/// Returns true for properties that move the outline.
fn counts(name: &str) -> bool {
    const PARTS: [&str; 24] = [
        "fill",
        "stroke",
        "opacity",
        "display",
        "visibility",
        "clip",
        "mask",
        "filter",
        "transform",
        "marker",
        "paint-order",
        "vector-effect",
        "overflow",
        "translate",
        "rotate",
        "scale",
        "mix-blend",
        "offset",
        "width",
        "height",
        "color",
        "stop-",
        "zoom",
        "--",
    ];
    PARTS.iter().any(|p| name.starts_with(p))
        || matches!(name, "d" | "x" | "y" | "r" | "cx" | "cy" | "rx" | "ry")
}

/// Declarations by property, the strongest first.
pub(super) struct Declared(HashMap<String, Vec<Declaration>>);

/// The outcome of the cascade for one property.
pub(super) enum Picked<T> {
    /// Nothing is declared.
    Absent,
    Inherit,
    Initial,
    Unset,
    Is(T),
    /// No declaration can be read; the text is the refusal.
    Unread(String),
    /// The declarations are not valid; browsers ignore them. The text says so.
    Wrong(String),
}

impl Declared {
    /// The custom properties of an element whose parent has `inherited`.
    pub fn custom(&self, inherited: &Custom) -> Custom {
        let own = self.0.iter().filter(|(name, _)| name.starts_with("--"));
        let mut own = own.peekable();
        if own.peek().is_none() {
            return Rc::clone(inherited);
        }
        let mut all = HashMap::clone(inherited);
        for (name, list) in own {
            match list.first().map(|d| d.value.as_str()) {
                Some("inherit" | "unset") | None => {}
                Some("initial") => drop(all.remove(name)),
                Some(value) => drop(all.insert(name.clone(), value.to_owned())),
            }
        }
        Rc::new(all)
    }

    /// The strongest declaration of CSS of a property, as text.
    pub fn css(&self, name: &str) -> Option<&str> {
        let first = self.0.get(name)?.iter().find(|d| d.css)?;
        Some(&first.value)
    }

    /// Picks the strongest declaration that `read` can read. It gets the value and `true` for one
    /// of CSS.
    pub fn pick<T>(
        &self,
        name: &str,
        custom: &Custom,
        node: Node,
        notes: &mut Notes,
        read: &dyn Fn(&str, bool) -> Value<T>,
    ) -> Picked<T> {
        let mut fault = None;
        let Some(list) = self.0.get(name) else {
            return Picked::Absent;
        };
        for d in list {
            let filled = match d.value.contains("var(") {
                true => substituted(&d.value, custom, 0),
                false => Some(d.value.clone()),
            };
            let said = || {
                let value = one_line(&d.value);
                match d.css {
                    true => format!("\"{name}: {value}\" (line {})", line(node)),
                    false => format!("{name}=\"{value}\" (line {})", line(node)),
                }
            };
            let Some(value) = filled else {
                let text = format!(
                    "the drawing has {}, which is not set; write the value itself",
                    said()
                );
                fault.get_or_insert(Picked::Unread(text));
                continue;
            };
            match value.to_ascii_lowercase().as_str() {
                "" => continue,
                "inherit" => return Picked::Inherit,
                "initial" => return Picked::Initial,
                "unset" | "revert" | "revert-layer" => return Picked::Unset,
                _ => {}
            }
            match read(&value, d.css) {
                Value::Is(v) => {
                    if let Some(Picked::Unread(text)) = fault {
                        let text = text.split(';').next().unwrap_or_default();
                        notes.warn(format!("{text}; the declaration before it counts"));
                    }
                    return Picked::Is(v);
                }
                Value::Near(v, how) => {
                    notes.warn(format!("the drawing has {}; {how}", said()));
                    return Picked::Is(v);
                }
                Value::Unread(remedy) => {
                    let text = format!("the drawing has {}, which is not read; {remedy}", said());
                    fault.get_or_insert(Picked::Unread(text));
                }
                Value::Wrong => {
                    let text = format!("the drawing has {}, which is not valid", said());
                    fault.get_or_insert(Picked::Wrong(text));
                }
            }
        }
        fault.unwrap_or(Picked::Absent)
    }
}

/// Fills custom properties in. `None` for one that is not set.
fn substituted(text: &str, custom: &Custom, depth: usize) -> Option<String> {
    if depth > MOST_NESTED {
        return None;
    }
    let mut out = String::new();
    let mut rest = text;
    while let Some((before, after)) = rest.split_once("var(") {
        let mut open = 1;
        let end = after.char_indices().find_map(|(i, c)| {
            open += i32::from(c == '(') - i32::from(c == ')');
            (open == 0).then_some(i)
        })?;
        let (name, fallback) = match after[..end].split_once(',') {
            Some((name, fallback)) => (name, Some(fallback)),
            None => (&after[..end], None),
        };
        let value = custom.get(name.trim()).map(String::as_str).or(fallback)?;
        out.push_str(before);
        out.push_str(substituted(value, custom, depth + 1)?.trim());
        if out.len() > MOST_BYTES {
            return None;
        }
        rest = &after[end + 1..];
    }
    out.push_str(rest);
    Some(out)
}
