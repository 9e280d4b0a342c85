//! The cascade: which declaration of a property counts for an element.

use crate::css::selector::Matcher;
use crate::css::{Declaration, Rule, declarations, media, one_line, plain, sheet};
use crate::element::{XHTML, attribute, is_svg};
use crate::notes::{Fault, Notes, OTHER_SHEET, Result};
use roxmltree::Node;
use std::collections::HashMap;

/// Importance, then attribute, rule or `style` attribute, then specificity.
type Strength = (bool, u8, u32);

/// All style sheets of a drawing.
pub(crate) struct Sheets {
    rules: Vec<Rule>,
    matcher: Matcher,
}

impl Sheets {
    pub fn of(document: &roxmltree::Document, notes: &mut Notes) -> Self {
        let mut rules = Vec::new();
        let mut title = None;
        for node in document.descendants() {
            if node.pi().is_some_and(|pi| pi.target == "xml-stylesheet") {
                notes.warn(OTHER_SHEET.to_owned());
            }
            let is_known = is_svg(node) || node.tag_name().namespace() == Some(XHTML);
            if !is_known || node.tag_name().name() != "style" {
                continue;
            }
            if !matches!(attribute(node, "type"), None | Some("" | "text/css")) {
                continue;
            }
            // Of several sheets with titles, those with the first title count.
            let own = attribute(node, "title").filter(|t| !t.is_empty());
            if own.is_some_and(|own| *title.get_or_insert(own) != own) {
                continue;
            }
            let condition = attribute(node, "media").unwrap_or_default();
            let applies = media(condition);
            if applies == Some(false) {
                continue;
            }
            let mut own = sheet(&content(node), notes.line(node), notes);
            if applies.is_none() {
                let unread = format!("<style media=\"{}\">", one_line(condition));
                own.iter_mut().for_each(|r| r.unread = Some(unread.clone()));
            }
            rules.append(&mut own);
        }
        Self {
            rules,
            matcher: Matcher::default(),
        }
    }

    /// The declarations for an element, the strongest first.
    ///
    /// # Errors
    /// If a rule that is not read may show the element, or selectors take too long.
    pub fn declared(&self, node: Node) -> Result<Declared> {
        let mut found: Vec<(Strength, Declaration)> = attributes(node);
        let mut fault = None;
        for rule in &self.rules {
            let matching = rule
                .selectors
                .iter()
                .filter(|s| self.matcher.matches(s, node));
            let specificity = matching.map(|s| s.specificity()).max();
            let declared = || rule.declarations.iter().map(|d| d.name.as_str());
            if let Some(unread) = &rule.unread {
                let may_match = specificity.is_some() || rule.selectors.is_empty();
                if !may_match || !declared().any(counts) {
                    continue;
                }
                let text = format!(
                    "the drawing has the rule \"{unread}\" (line {}), which is not read; \
                     give the elements their properties directly",
                    rule.line
                );
                if declared().any(shows) {
                    return Err(Fault::new(text));
                }
                fault.get_or_insert(text);
            } else if let Some(specificity) = specificity {
                for d in &rule.declarations {
                    found.push(((d.important, 1, specificity), d.clone()));
                }
            }
        }
        if self.matcher.is_spent() {
            return Err(Fault::new(
                "the drawing has selectors that take too long; write simpler ones",
            ));
        }
        for d in declarations(attribute(node, "style").unwrap_or_default()) {
            found.push(((d.important, 2, 0), d));
        }
        // A stable sort keeps the order of the document among equals.
        found.sort_by_key(|(strength, _)| *strength);
        let mut declared = Declared {
            properties: HashMap::new(),
            all: None,
            fault,
        };
        for (_, d) in found.into_iter().rev() {
            declared.add(d)?;
        }
        Ok(declared)
    }
}

/// The attributes that may be properties, as declarations.
fn attributes(node: Node) -> Vec<(Strength, Declaration)> {
    let own = node.attributes().filter(|a| a.namespace().is_none());
    let own = own.filter(|a| !matches!(a.name(), "style" | "class" | "id"));
    let declaration = |a: roxmltree::Attribute| {
        let is_value = !matches!(a.name(), "d" | "transform") && a.value().contains("/*");
        let value = match is_value {
            true => plain(&mut cssparser::Parser::new(a.value())),
            false => a.value().to_owned(),
        };
        Declaration {
            name: a.name().to_owned(),
            value: value.trim().to_owned(),
            important: false,
            css: false,
        }
    };
    own.map(|a| ((false, 0, 0), declaration(a))).collect()
}

/// The text of an element. Comments within it leave their line ends.
fn content(node: Node) -> String {
    let mut text = String::new();
    for child in node.children() {
        match (child.is_text(), child.text()) {
            (true, Some(own)) => text.push_str(own),
            (_, own) => text.extend(own.unwrap_or_default().chars().filter(|c| *c == '\n')),
        }
    }
    text
}

/// Returns true for properties that may show what is hidden.
fn shows(name: &str) -> bool {
    matches!(name, "display" | "visibility" | "opacity" | "all") || name.starts_with("--")
}

/// Returns true for properties that move the outline.
fn counts(name: &str) -> bool {
    const BEGINNINGS: &str = "all background fill stroke opacity display visibility clip mask filter transform \
        marker paint-order vector-effect overflow translate rotate scale mix-blend offset width height color stop- \
        zoom --";
    BEGINNINGS.split(' ').any(|part| name.starts_with(part))
        || matches!(name, "d" | "x" | "y" | "r" | "cx" | "cy" | "rx" | "ry")
}

/// Declarations by property, the strongest first.
pub(crate) struct Declared {
    pub properties: HashMap<String, Vec<Declaration>>,
    /// What `all` makes of the properties without stronger declarations.
    pub all: Option<Wide>,
    /// The refusal of a rule that may be for the element.
    pub fault: Option<String>,
}

/// A keyword that every property has.
#[derive(Clone, Copy, PartialEq)]
pub(crate) enum Wide {
    Inherit,
    Initial,
    Unset,
}

impl Wide {
    pub fn of(text: &str) -> Option<Self> {
        Some(match text.to_ascii_lowercase().as_str() {
            "inherit" => Self::Inherit,
            "initial" => Self::Initial,
            "unset" | "revert" => Self::Unset,
            _ => return None,
        })
    }
}

impl Declared {
    /// Adds the next weaker declaration.
    fn add(&mut self, d: Declaration) -> Result<()> {
        // Ends of lines are no properties.
        let free = d.name.starts_with("--") || matches!(&*d.name, "x1" | "x2" | "y1" | "y2");
        if self.all.is_some() && !free {
            return Ok(());
        }
        if d.name == "all" && d.css {
            self.all = Wide::of(&d.value);
            return match d.value.eq_ignore_ascii_case("revert-layer") {
                true => Err(Fault::new(
                    "the drawing has \"all: revert-layer\", which is not read; write the values themselves",
                )),
                false => Ok(()),
            };
        }
        let names: &[&str] = match d.name.as_str() {
            "marker" if d.css => &["marker-start", "marker-mid", "marker-end"],
            own => &[own],
        };
        for name in names {
            let list = self.properties.entry((*name).to_owned()).or_default();
            list.push(d.clone());
        }
        Ok(())
    }

    /// The strongest declaration of CSS of a property, as text.
    pub fn css(&self, name: &str) -> Option<&str> {
        let first = self.properties.get(name)?.iter().find(|d| d.css)?;
        Some(&first.value)
    }
}
