//! Selectors of CSS: which elements a rule is for.

use crate::element::{attribute, is_in};
use cssparser::{Parser, ToCss};
use precomputed_hash::PrecomputedHash;
use roxmltree::Node;
use selectors::attr::{AttrSelectorOperation, CaseSensitivity, NamespaceConstraint};
use selectors::bloom::BloomFilter;
use selectors::context::{
    MatchingContext, MatchingForInvalidation, MatchingMode, NeedsSelectorFlags, QuirksMode,
    SelectorCaches,
};
use selectors::matching::{ElementSelectorFlags, matches_selector};
use selectors::parser::{
    Component, NonTSPseudoClass, ParseRelative, PseudoElement, SelectorImpl, SelectorList,
    SelectorParseError, SelectorParseErrorKind,
};
use selectors::{Element, OpaqueElement};
use std::borrow::Borrow;
use std::cell::{Cell, RefCell};
use std::fmt::{Result as Written, Write};
use std::num::NonZeroUsize;
use std::ptr::NonNull;

/// Parentheses may be nested this deep.
const MOST_NESTED: u8 = 16;
/// Most parts of a selector: matching goes deeper with each.
const MOST_PARTS: usize = 100;
/// Most tries of a selector with an element, and steps from there to others, of one drawing.
const MOST_STEPS: u64 = 30_000_000;
/// Pseudo-elements, such as `::selection`.
const ELEMENTS: &str = "before after selection marker first-line first-letter";
/// Pseudo-classes that no element of a still picture has.
const NEVER: &str =
    "hover active focus focus-visible focus-within visited target checked disabled enabled";

/// A selector without commas.
pub(crate) type Selector = selectors::parser::Selector<Drawings>;

/// Reads selectors that commas separate. `None` for one that is not read.
pub(crate) fn selectors(text: &str) -> Option<Vec<Selector>> {
    let mut input = Parser::new(text);
    input.set_nested_block_limit(MOST_NESTED);
    let list = SelectorList::parse(&Drawings, &mut input, ParseRelative::No).ok()?;
    let is_read = list.slice().iter().all(is_short);
    is_read.then(|| list.slice().to_vec())
}

/// Returns true for a selector of few parts, those in parentheses too.
fn is_short(selector: &Selector) -> bool {
    let mut parts = selector.iter_raw_match_order();
    selector.len() <= MOST_PARTS
        && parts.all(|part| match part {
            Component::Is(list) | Component::Where(list) | Component::Negation(list) => {
                list.slice().iter().all(is_short)
            }
            _ => true,
        })
}

/// Matches selectors with the elements of one drawing.
#[derive(Default)]
pub(crate) struct Matcher {
    caches: RefCell<SelectorCaches>,
    steps: Cell<u64>,
}

impl Matcher {
    /// Returns true after too many steps; then selectors match nothing more.
    pub fn is_spent(&self) -> bool {
        self.steps.get() > MOST_STEPS
    }

    /// Returns true if a selector is for this element.
    pub fn matches(&self, selector: &Selector, node: Node) -> bool {
        self.steps.set(self.steps.get() + 1);
        if self.is_spent() {
            return false;
        }
        let mut caches = self.caches.borrow_mut();
        let mut context = MatchingContext::new(
            MatchingMode::Normal,
            None,
            &mut caches,
            QuirksMode::NoQuirks,
            NeedsSelectorFlags::No,
            MatchingForInvalidation::No,
        );
        let matcher = self;
        matches_selector(selector, 0, None, Tried { node, matcher }, &mut context)
    }
}

/// The selectors of drawings: no namespaces but one.
#[derive(Clone, Debug)]
pub(crate) struct Drawings;

#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(crate) struct Name(String);

impl From<&str> for Name {
    fn from(text: &str) -> Self {
        Self(text.to_owned())
    }
}

impl AsRef<str> for Name {
    fn as_ref(&self) -> &str {
        &self.0
    }
}

impl Borrow<str> for Name {
    fn borrow(&self) -> &str {
        &self.0
    }
}

impl PrecomputedHash for Name {
    fn precomputed_hash(&self) -> u32 {
        // For Bloom filters, which are not used.
        0
    }
}

/// Pseudo-classes other than those of places among siblings, and pseudo-elements.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) enum Pseudo {
    Always,
    Link,
    Never,
}

macro_rules! write_nothing {
    ($($type:ty)*) => {$(
        impl ToCss for $type {
            fn to_css<W: Write>(&self, _: &mut W) -> Written {
                Ok(())
            }
        }
    )*};
}
write_nothing! { Name Pseudo }

impl PseudoElement for Pseudo {}

/// What elements of drawings do not have, such as shadow trees of HTML.
macro_rules! has_not {
    ($(fn $name:ident($($argument:ty),*) -> $result:ty: $none:expr;)*) => {$(
        fn $name(&self $(, _: $argument)*) -> $result {
            $none
        }
    )*};
}

impl NonTSPseudoClass for Pseudo {
    has_not! {
        fn is_active_or_hover() -> bool: false;
        fn is_user_action_state() -> bool: false;
    }
}

impl SelectorImpl for Drawings {
    type ExtraMatchingData<'a> = ();
    type AttrValue = Name;
    type Identifier = Name;
    type LocalName = Name;
    type NamespaceUrl = Name;
    type NamespacePrefix = Name;
    type BorrowedNamespaceUrl = str;
    type BorrowedLocalName = str;
    type NonTSPseudoClass = Pseudo;
    type PseudoElement = Pseudo;
}

fn unread<T>() -> Result<T, SelectorParseError> {
    Err(SelectorParseError::custom(
        SelectorParseErrorKind::UnsupportedPseudoClassOrElement,
    ))
}

impl selectors::Parser<'_> for Drawings {
    type Impl = Self;
    type Error = SelectorParseErrorKind;

    fn parse_is_and_where(&self) -> bool {
        true
    }

    fn is_is_alias(&self, name: &str) -> bool {
        name.eq_ignore_ascii_case("matches")
    }

    fn allow_forgiving_selectors(&self) -> bool {
        false
    }

    fn parse_non_ts_pseudo_class(&self, name: &str) -> Result<Pseudo, SelectorParseError> {
        match name.to_ascii_lowercase().as_str() {
            name if is_in(NEVER, name) => Ok(Pseudo::Never),
            "link" | "any-link" => Ok(Pseudo::Link),
            "defined" => Ok(Pseudo::Always),
            _ => unread(),
        }
    }

    fn parse_pseudo_element(&self, name: &str) -> Result<Pseudo, SelectorParseError> {
        match is_in(ELEMENTS, &name.to_ascii_lowercase()) || name.starts_with("-webkit-") {
            true => Ok(Pseudo::Never),
            // Others make the rule invalid.
            false => unread(),
        }
    }

    /// Every prefix is that of the drawing's namespace.
    fn namespace_for_prefix(&self, _: &Name) -> Option<Name> {
        Some("svg".into())
    }
}

/// An element that selectors are tried with.
#[derive(Clone, Copy)]
struct Tried<'n> {
    node: Node<'n, 'n>,
    matcher: &'n Matcher,
}

impl std::fmt::Debug for Tried<'_> {
    fn fmt(&self, f: &mut std::fmt::Formatter) -> Written {
        self.node.fmt(f)
    }
}

impl<'n> Tried<'n> {
    /// The element one step away, unless there were too many steps.
    fn at(self, node: Option<Node<'n, 'n>>) -> Option<Self> {
        self.matcher.steps.set(self.matcher.steps.get() + 1);
        let node = node.filter(|_| !self.matcher.is_spent())?;
        Some(Self { node, ..self })
    }
}

impl Element for Tried<'_> {
    type Impl = Drawings;

    fn opaque(&self) -> OpaqueElement {
        let id = NonZeroUsize::MIN.saturating_add(self.node.id().get_usize());
        OpaqueElement::from_ptr(NonNull::without_provenance(id))
    }

    fn parent_element(&self) -> Option<Self> {
        self.at(self.node.parent_element())
    }

    fn prev_sibling_element(&self) -> Option<Self> {
        self.at(self.node.prev_sibling_element())
    }

    fn next_sibling_element(&self) -> Option<Self> {
        self.at(self.node.next_sibling_element())
    }

    fn first_element_child(&self) -> Option<Self> {
        self.at(self.node.first_element_child())
    }

    fn has_local_name(&self, name: &str) -> bool {
        self.node.tag_name().name() == name
    }

    fn has_namespace(&self, namespace: &str) -> bool {
        !namespace.is_empty()
    }

    fn is_same_type(&self, other: &Self) -> bool {
        self.has_local_name(other.node.tag_name().name())
    }

    fn attr_matches(
        &self,
        _: &NamespaceConstraint<&Name>,
        name: &Name,
        operation: &AttrSelectorOperation<&Name>,
    ) -> bool {
        attribute(self.node, &name.0).is_some_and(|value| operation.eval_str(value))
    }

    fn match_non_ts_pseudo_class(&self, class: &Pseudo, _: &mut MatchingContext<Drawings>) -> bool {
        *class == Pseudo::Always || (*class == Pseudo::Link && self.is_link())
    }

    fn is_link(&self) -> bool {
        let mut attributes = self.node.attributes();
        self.has_local_name("a") && attributes.any(|a| a.name() == "href")
    }

    fn has_id(&self, id: &Name, _: CaseSensitivity) -> bool {
        attribute(self.node, "id") == Some(&id.0)
    }

    fn has_class(&self, name: &Name, _: CaseSensitivity) -> bool {
        let classes = attribute(self.node, "class").unwrap_or_default();
        classes
            .split_ascii_whitespace()
            .any(|class| class == name.0)
    }

    fn is_empty(&self) -> bool {
        self.node.children().all(|c| c.is_comment() || c.is_pi())
    }

    fn is_root(&self) -> bool {
        self.node.parent_element().is_none()
    }

    fn apply_selector_flags(&self, _: ElementSelectorFlags) {}

    has_not! {
        fn parent_node_is_shadow_root() -> bool: false;
        fn containing_shadow_host() -> Option<Self>: None;
        fn is_pseudo_element() -> bool: false;
        fn is_html_element_in_html_document() -> bool: false;
        fn is_html_slot_element() -> bool: false;
        fn has_custom_state(&Name) -> bool: false;
        fn imported_part(&Name) -> Option<Name>: None;
        fn is_part(&Name) -> bool: false;
        fn match_pseudo_element(&Pseudo, &mut MatchingContext<Drawings>) -> bool: false;
        fn add_element_unique_hashes(&mut BloomFilter) -> bool: false;
    }
}
