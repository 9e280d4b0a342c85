//! The reading of one element's properties: the declaration that counts for each, and what becomes
//! of those that are not read.

use crate::css::cascade::{Declared, Wide};
use crate::css::custom::{Custom, filled};
use crate::css::one_line;
use crate::notes::{Fault, Notes, Result, unsupported};
use crate::value::Unusable::{Unread, Wrong};
use crate::value::Value;
use crate::value::color::before_profile;
use crate::value::paint::Paint;
use roxmltree::Node;
use std::rc::Rc;

/// What is wrong with the declarations of a property.
enum Trouble {
    /// None can be read; the text is the refusal.
    Unread(String),
    /// They are not valid; browsers ignore them. The text says so.
    Wrong(String),
}

/// The field that a property is read into, the parent's value, the initial value.
pub(crate) type Fields<'a, T> = (&'a mut T, &'a T, &'a T);

/// The reading of one element's properties.
pub(crate) struct Reading<'a, 'b> {
    pub declared: &'a Declared,
    pub custom: Custom,
    pub node: Node<'b, 'b>,
    pub notes: &'a mut Notes,
    /// The first refusal, for an element that shows.
    pub fault: Option<Rc<str>>,
}

impl Reading<'_, '_> {
    pub fn is_root(&self) -> bool {
        self.node.parent_element().is_none()
    }

    /// Reads a property into its field, which holds the value for one that is not declared, by the
    /// strongest declaration that `read` can read. It gets the text and `true` for one of CSS. Those
    /// that are not read are skipped only if `lenient`, with a warning. Returns what is wrong.
    fn pick<T: Clone>(
        &mut self,
        name: &str,
        (slot, parent, initial): Fields<T>,
        inherited: bool,
        lenient: bool,
        read: &dyn Fn(&str, bool) -> Value<T>,
    ) -> Option<Trouble> {
        let declared = self.declared;
        let of_word = |wide: Wide| match wide {
            Wide::Inherit => parent.clone(),
            Wide::Unset if inherited => parent.clone(),
            Wide::Initial | Wide::Unset => initial.clone(),
        };
        let mut trouble = None;
        let list = declared.properties.get(name);
        let list = list.map_or(&[][..], Vec::as_slice);
        for d in list.iter().filter(|d| !d.value.is_empty()) {
            let line = self.notes.line(self.node);
            let said = || {
                let value = one_line(&d.value);
                match d.css {
                    true => format!("\"{name}: {value}\" (line {line})"),
                    false => format!("{name}=\"{value}\" (line {line})"),
                }
            };
            let unread =
                |why: &str| Trouble::Unread(format!("the drawing has {}, which is {why}", said()));
            let Some(value) = filled(&d.value, &self.custom) else {
                return Some(unread("not set; write the value itself"));
            };
            if let Some(wide) = Wide::of(&value) {
                *slot = of_word(wide);
                return None;
            }
            match read(&value, d.css) {
                _ if value.eq_ignore_ascii_case("revert-layer") => {
                    return Some(unread("not read; write the value"));
                }
                Ok(v) => {
                    if before_profile(&value).is_some() {
                        let how = "its sRGB colour counts, not the one after it";
                        self.notes
                            .warn(format!("the drawing has {}; {how}", said()));
                    } else if let Some(Trouble::Unread(text)) = trouble {
                        let text = text.split(';').next().unwrap_or_default();
                        let how = "the declaration before it counts";
                        self.notes.warn(format!("{text}; {how}"));
                    }
                    *slot = v;
                    return None;
                }
                Err(Unread(remedy)) => {
                    let unread = unread(&format!("not read; {remedy}"));
                    if !lenient {
                        return Some(unread);
                    }
                    trouble.get_or_insert(unread);
                }
                // Browsers find this too late to go back to the declaration before it.
                Err(Wrong) if d.value.contains("var(") => {
                    *slot = of_word(Wide::Unset);
                    return None;
                }
                Err(Wrong) => {
                    let text = format!("the drawing has {}, which is not valid", said());
                    trouble.get_or_insert(Trouble::Wrong(text));
                }
            }
        }
        if let (None, Some(all)) = (&trouble, declared.all) {
            *slot = of_word(all);
        }
        trouble
    }

    pub fn value<T: Clone>(
        &mut self,
        name: &str,
        fields: Fields<T>,
        inherited: bool,
        read: &dyn Fn(&str, bool) -> Value<T>,
    ) -> Result<()> {
        match self.pick(name, fields, inherited, false, read) {
            Some(Trouble::Unread(text)) if matches!(name, "display" | "visibility" | "opacity") => {
                return Err(Fault::new(text));
            }
            Some(Trouble::Unread(text)) => drop(self.fault.get_or_insert(text.into())),
            Some(Trouble::Wrong(text)) => {
                self.notes
                    .warn(format!("{text}; it is ignored, as browsers do"));
            }
            None => {}
        }
        Ok(())
    }

    /// Reads a paint. One that is not read is refused only if something is painted with it.
    #[expect(clippy::unnecessary_wraps, reason = "called as `value` is, by a table")]
    pub fn paint(
        &mut self,
        name: &str,
        (slot, parent, initial): Fields<Paint>,
        inherited: bool,
        read: &dyn Fn(&str, bool) -> Value<Paint>,
    ) -> Result<()> {
        match self.pick(name, (slot, parent, initial), inherited, true, read) {
            Some(Trouble::Unread(text)) => *slot = Paint::Fault(text.into()),
            Some(Trouble::Wrong(text)) => {
                let text = text.replace("which is not valid", "which is no colour");
                *slot = Paint::Fault(format!("{text}; write the colour as #rrggbb").into());
            }
            None => {}
        }
        Ok(())
    }

    /// Refuses a property of CSS with another value than the `usual` ones, if the element shows.
    pub fn refuse(&mut self, name: &str, usual: &[&str], remedy: &str) {
        let known = ["", "initial", "unset", "inherit", "auto"];
        let mut usual = usual.iter().chain(&known);
        let unusual = |v: &&str| !usual.any(|u| u.eq_ignore_ascii_case(v));
        if let Some(value) = self.declared.css(name).filter(unusual) {
            let text = unsupported(self.node, &format!("\"{name}: {value}\""), remedy).to_string();
            self.fault.get_or_insert(text.into());
        }
    }
}
