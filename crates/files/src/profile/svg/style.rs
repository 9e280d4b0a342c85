//! The computed style of an element.

use super::cascade::{Custom, Declared, Picked, Sheets};
use super::color::{BLACK, Color, color};
use super::notes::{Notes, unsupported};
use super::shapes::{LENGTHS, css_path, is_auto};
use super::transform::{Base, origin, rotate, scale, transform, translate};
use super::value::{Fonts, Length, Value, alpha, length, list, number, unescaped, url};
use crate::content_fault;
use kurbo::{Cap, Join};
use revmap::error::Result;
use revmap::profile::FillRule;
use roxmltree::Node;
use std::rc::Rc;

/// A paint as declared.
#[derive(Clone, Debug)]
pub(super) enum Paint {
    None,
    Color(Color),
    Current,
    /// The fill (`false`) or stroke (`true`) of what uses a marker or a symbol.
    Context(bool),
    /// A gradient or pattern, and what counts if it is missing.
    Server(Target, Option<Box<Paint>>),
    /// A paint that is not read; the refusal, if anything is painted with it.
    Fault(Rc<str>),
}

/// An element of the drawing by its id, or the address of one elsewhere.
pub(super) type Target = std::result::Result<Rc<str>, Rc<str>>;

/// Everything that an element inherits, and its own part.
#[derive(Clone, Debug)]
pub(super) struct Style {
    custom: Custom,
    pub fonts: Fonts,
    pub color: Paint,
    pub fill: Paint,
    pub stroke: Paint,
    pub fill_opacity: f32,
    pub stroke_opacity: f32,
    pub fill_rule: FillRule,
    pub clip_rule: FillRule,
    pub stroke_width: Length,
    pub cap: Cap,
    pub join: Join,
    pub miter_limit: f64,
    pub dashes: Vec<Length>,
    pub dash_offset: Length,
    /// Fill, stroke, markers: the order of painting.
    pub order: [u8; 3],
    pub visible: bool,
    /// Start, middle, end.
    pub markers: [Option<Target>; 3],
    /// Fill and stroke of what uses this content.
    pub context: Rc<(Paint, Paint)>,
    pub own: Own,
}

/// The part of a style that is not inherited.
#[derive(Clone, Debug)]
pub(super) struct Own {
    pub display: bool,
    /// The refusal of a property that is not read, if the element shows.
    pub fault: Option<Rc<str>>,
    pub opacity: f32,
    pub clip_path: Option<Target>,
    pub filter: Option<Target>,
    pub mask: Option<Target>,
    pub vector_effect: bool,
    pub overflow: bool,
    pub stop_color: Paint,
    pub stop_opacity: f32,
    /// The function list of `transform`, and `true` if it is of CSS.
    pub transform: Option<(String, bool)>,
    /// The properties `translate`, `rotate`, `scale`.
    pub moved: [Option<String>; 3],
    pub origin: Option<String>,
    pub reference: Reference,
    /// The ground of the page, for the root alone.
    pub background: Paint,
    lengths: Vec<(&'static str, Length)>,
    /// The data of a path.
    pub path_data: Option<String>,
}

/// The box that a transform refers to.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Reference {
    View,
    Fill,
    Stroke,
}

impl Own {
    /// # Errors
    /// If a property is not read.
    pub fn check(&self) -> Result<()> {
        match &self.fault {
            Some(text) => Err(content_fault(&**text)),
            None => Ok(()),
        }
    }
}

impl Default for Own {
    fn default() -> Self {
        Self {
            display: true,
            fault: None,
            opacity: 1.0,
            clip_path: None,
            filter: None,
            mask: None,
            vector_effect: false,
            overflow: false,
            stop_color: Paint::Color(BLACK),
            stop_opacity: 1.0,
            transform: None,
            moved: [const { None }; 3],
            origin: None,
            reference: Reference::View,
            background: Paint::None,
            lengths: Vec::new(),
            path_data: None,
        }
    }
}

impl Default for Style {
    fn default() -> Self {
        Self {
            custom: Custom::default(),
            fonts: Fonts {
                own: 16.0,
                root: 16.0,
            },
            color: Paint::Color(BLACK),
            fill: Paint::Color(BLACK),
            stroke: Paint::None,
            fill_opacity: 1.0,
            stroke_opacity: 1.0,
            fill_rule: FillRule::NonZero,
            clip_rule: FillRule::NonZero,
            stroke_width: Length::Px(1.0),
            cap: Cap::Butt,
            join: Join::Miter,
            miter_limit: 4.0,
            dashes: Vec::new(),
            dash_offset: Length::ZERO,
            order: [0, 1, 2],
            visible: true,
            markers: [const { None }; 3],
            context: Rc::new((Paint::None, Paint::None)),
            own: Own::default(),
        }
    }
}

impl Style {
    /// A length of the geometry, if it is given.
    pub fn geometry(&self, name: &str) -> Option<Length> {
        let found = self.own.lengths.iter().find(|(n, _)| *n == name);
        found.map(|(_, length)| *length)
    }

    /// The style of an element whose parent has the style `parent`.
    pub fn of(node: Node, parent: &Self, sheets: &Sheets, notes: &mut Notes) -> Result<Self> {
        let declared = sheets.declared(node)?;
        let initial = Self::default();
        let mut style = Self {
            own: Own::default(),
            ..parent.clone()
        };
        style.custom = declared.custom(&parent.custom)?;
        let custom = Rc::clone(&style.custom);
        let mut c = Computed {
            declared: &declared,
            custom,
            node,
            notes,
            fault: declared.fault.as_deref().map(Rc::from),
        };
        style.read_fonts(parent, &mut c)?;
        style.read_paints(parent, &initial, &mut c)?;
        style.read_strokes(parent, &initial, &mut c)?;
        style.read_own(parent, &mut c)?;
        style.read_geometry(&mut c)?;
        style.own.fault = c.fault;
        Ok(style)
    }

    fn read_fonts(&mut self, parent: &Self, c: &mut Computed) -> Result<()> {
        let (size, root) = (parent.fonts.own, parent.fonts.root);
        let own = |text: &str, css: bool| {
            let step = match text.to_ascii_lowercase().as_str() {
                "xx-small" => 0.5625,
                "x-small" => 0.625,
                "small" => 0.8125,
                "medium" => 1.0,
                "large" => 1.125,
                "x-large" => 1.5,
                "xx-large" => 2.0,
                "smaller" => return Value::Is(size / 1.2),
                "larger" => return Value::Is(size * 1.2),
                _ => {
                    return match length(text, parent.fonts, !css).map(|l| l.of(size)) {
                        // Fonts matter only to lengths in em.
                        Value::Unread(_) => Value::Is(size),
                        other => other,
                    };
                }
            };
            Value::Is(16.0 * step)
        };
        c.take("font-size", &mut self.fonts.own, &size, &16.0, true, &own)?;
        let is_root = c.node.parent_element().is_none();
        self.fonts.root = if is_root { self.fonts.own } else { root };
        Ok(())
    }

    fn read_paints(&mut self, parent: &Self, initial: &Self, c: &mut Computed) -> Result<()> {
        let plain = |text: &str, _: bool| match text.eq_ignore_ascii_case("currentcolor") {
            true => Value::Is(Paint::Current),
            false => color(text).map(Paint::Color),
        };
        c.paint(
            "color",
            &mut self.color,
            &parent.color,
            &initial.color,
            true,
            &plain,
        );
        if matches!(self.color, Paint::Current) {
            self.color = parent.color.clone();
        }
        let any = |text: &str, _: bool| paint(text);
        c.paint(
            "fill",
            &mut self.fill,
            &parent.fill,
            &initial.fill,
            true,
            &any,
        );
        c.paint(
            "stroke",
            &mut self.stroke,
            &parent.stroke,
            &initial.stroke,
            true,
            &any,
        );
        let (stop, of_parent) = (&mut self.own.stop_color, &parent.own.stop_color);
        c.paint(
            "stop-color",
            stop,
            of_parent,
            &initial.own.stop_color,
            false,
            &plain,
        );
        let alpha = |text: &str, _: bool| alpha(text);
        c.take(
            "fill-opacity",
            &mut self.fill_opacity,
            &parent.fill_opacity,
            &1.0,
            true,
            &alpha,
        )?;
        c.take(
            "stroke-opacity",
            &mut self.stroke_opacity,
            &parent.stroke_opacity,
            &1.0,
            true,
            &alpha,
        )?;
        c.take(
            "stop-opacity",
            &mut self.own.stop_opacity,
            &parent.own.stop_opacity,
            &1.0,
            false,
            &alpha,
        )?;
        c.take(
            "opacity",
            &mut self.own.opacity,
            &parent.own.opacity,
            &1.0,
            false,
            &alpha,
        )
    }

    fn read_strokes(&mut self, parent: &Self, initial: &Self, c: &mut Computed) -> Result<()> {
        let fonts = self.fonts;
        let rule = words(&[
            ("nonzero", FillRule::NonZero),
            ("evenodd", FillRule::EvenOdd),
        ]);
        c.take(
            "fill-rule",
            &mut self.fill_rule,
            &parent.fill_rule,
            &initial.fill_rule,
            true,
            &rule,
        )?;
        c.take(
            "clip-rule",
            &mut self.clip_rule,
            &parent.clip_rule,
            &initial.clip_rule,
            true,
            &rule,
        )?;
        let distance = |text: &str, _: bool| length(text, fonts, true);
        let positive = |text: &str, _: bool| match length(text, fonts, true) {
            Value::Is(Length::Px(v) | Length::Part(v)) if v < 0.0 => Value::Wrong,
            other => other,
        };
        c.take(
            "stroke-width",
            &mut self.stroke_width,
            &parent.stroke_width,
            &initial.stroke_width,
            true,
            &positive,
        )?;
        c.take(
            "stroke-dashoffset",
            &mut self.dash_offset,
            &parent.dash_offset,
            &initial.dash_offset,
            true,
            &distance,
        )?;
        let caps = words(&[
            ("butt", Cap::Butt),
            ("round", Cap::Round),
            ("square", Cap::Square),
        ]);
        c.take(
            "stroke-linecap",
            &mut self.cap,
            &parent.cap,
            &initial.cap,
            true,
            &caps,
        )?;
        let joins = words(&[
            ("miter", Join::Miter),
            ("round", Join::Round),
            ("bevel", Join::Bevel),
        ]);
        c.take(
            "stroke-linejoin",
            &mut self.join,
            &parent.join,
            &initial.join,
            true,
            &joins,
        )?;
        let limit = |text: &str, _: bool| match number(text) {
            Value::Is(v) if v < 0.0 => Value::Wrong,
            other => other,
        };
        c.take(
            "stroke-miterlimit",
            &mut self.miter_limit,
            &parent.miter_limit,
            &4.0,
            true,
            &limit,
        )?;
        let dashes = |text: &str, _: bool| {
            if text.eq_ignore_ascii_case("none") {
                return Value::Is(Vec::new());
            }
            if text.split(',').any(|part| part.trim().is_empty()) {
                return Value::Wrong;
            }
            let mut dashes = Vec::new();
            for part in list(text) {
                match positive(part, true) {
                    Value::Is(l) => dashes.push(l),
                    Value::Unread(remedy) => return Value::Unread(remedy),
                    _ => return Value::Wrong,
                }
            }
            Value::Is(dashes)
        };
        c.take(
            "stroke-dasharray",
            &mut self.dashes,
            &parent.dashes,
            &initial.dashes,
            true,
            &dashes,
        )?;
        c.take(
            "paint-order",
            &mut self.order,
            &parent.order,
            &initial.order,
            true,
            &|text, _| order(text),
        )?;
        let visible = words(&[("visible", true), ("hidden", false), ("collapse", false)]);
        c.take(
            "visibility",
            &mut self.visible,
            &parent.visible,
            &true,
            true,
            &visible,
        )?;
        for (k, name) in ["marker-start", "marker-mid", "marker-end"]
            .into_iter()
            .enumerate()
        {
            c.take(
                name,
                &mut self.markers[k],
                &parent.markers[k],
                &None,
                true,
                &|text, _| target(text),
            )?;
        }
        Ok(())
    }

    fn read_own(&mut self, parent: &Self, c: &mut Computed) -> Result<()> {
        let (own, before) = (&mut self.own, &parent.own);
        let is_container = matches!(
            c.node.tag_name().name(),
            "g" | "svg" | "use" | "a" | "switch"
        );
        let display = |text: &str, _: bool| match text.to_ascii_lowercase().as_str() {
            "none" => Value::Is(false),
            // Shapes have no content of their own.
            "contents" => Value::Is(is_container),
            word => Value::from_option(is_display(word).then_some(true)),
        };
        c.take(
            "display",
            &mut own.display,
            &before.display,
            &true,
            false,
            &display,
        )?;
        let clip = |text: &str, _: bool| match target(text) {
            Value::Wrong if text.contains('(') || text.ends_with("-box") => {
                Value::Unread("clip with a <clipPath>")
            }
            other => other,
        };
        c.take(
            "clip-path",
            &mut own.clip_path,
            &before.clip_path,
            &None,
            false,
            &clip,
        )?;
        let mask = |text: &str, _: bool| match target(text) {
            Value::Wrong => Value::Unread("clip with a path, or cut the shape"),
            other => other,
        };
        for name in ["mask-image", "mask"] {
            c.take(name, &mut own.mask, &before.mask, &None, false, &mask)?;
        }
        let filter = |text: &str, _: bool| match target(text) {
            Value::Wrong if text.contains('(') => Value::Unread("remove it"),
            other => other,
        };
        for name in ["backdrop-filter", "filter"] {
            c.take(name, &mut own.filter, &before.filter, &None, false, &filter)?;
        }
        let effect =
            |text: &str, _: bool| Value::Is(text.eq_ignore_ascii_case("non-scaling-stroke"));
        c.take(
            "vector-effect",
            &mut own.vector_effect,
            &before.vector_effect,
            &false,
            false,
            &effect,
        )?;
        let overflow = words(&[
            ("visible", true),
            ("auto", true),
            ("hidden", false),
            ("scroll", false),
            ("clip", false),
        ]);
        c.take(
            "overflow",
            &mut own.overflow,
            &before.overflow,
            &false,
            false,
            &overflow,
        )?;
        c.refuse("mix-blend-mode", &["normal"], "set it to normal");
        c.refuse(
            "zoom",
            &["1", "100%", "normal"],
            "scale the drawing instead",
        );
        c.refuse("offset-path", &["none"], "write the place as a transform");
        c.refuse("offset", &["none"], "write the place as a transform");
        c.refuse(
            "mask-box-image",
            &["none"],
            "clip with a path, or cut the shape",
        );
        for name in ["animation", "animation-name"] {
            if c.declared.css(name).is_some_and(|v| !v.starts_with("none")) {
                c.notes.warn(format!(
                    "the drawing has an animation (line {}), which is drawn at rest",
                    c.notes.line(c.node)
                ));
            }
        }
        if c.node.parent_element().is_none() {
            c.refuse(
                "background-image",
                &["none"],
                "draw a shape of one colour instead",
            );
            for name in ["background", "background-color"] {
                if c.declared.css(name).is_some() {
                    let slot = &mut own.background;
                    c.take(name, slot, &Paint::None, &Paint::None, false, &|text, _| {
                        ground(text)
                    })?;
                }
            }
        }
        let base = Base {
            fonts: self.fonts,
            size: (1.0, 1.0),
            css: false,
        };
        let listed = |text: &str, css: bool| {
            transform(text, Base { css, ..base }).map(|_| Some((text.to_owned(), css)))
        };
        c.take(
            "transform",
            &mut own.transform,
            &before.transform,
            &None,
            false,
            &listed,
        )?;
        let css = Base { css: true, ..base };
        type Read = fn(&str, Base) -> Value<kurbo::Affine>;
        let of_css: [(&str, Read); 3] = [
            ("translate", translate),
            ("rotate", rotate),
            ("scale", scale),
        ];
        for (k, (name, read)) in of_css.into_iter().enumerate() {
            if c.declared.css(name).is_some() {
                let kept = |text: &str, _: bool| read(text, css).map(|_| Some(text.to_owned()));
                c.take(
                    name,
                    &mut own.moved[k],
                    &before.moved[k],
                    &None,
                    false,
                    &kept,
                )?;
            }
        }
        let place = |text: &str, is_css: bool| {
            origin(
                text,
                Base {
                    css: is_css,
                    ..base
                },
            )
            .map(|_| Some(text.to_owned()))
        };
        c.take(
            "transform-origin",
            &mut own.origin,
            &before.origin,
            &None,
            false,
            &place,
        )?;
        let reference = words(&[
            ("view-box", Reference::View),
            ("fill-box", Reference::Fill),
            ("content-box", Reference::Fill),
            ("stroke-box", Reference::Stroke),
            ("border-box", Reference::Stroke),
        ]);
        c.take(
            "transform-box",
            &mut own.reference,
            &before.reference,
            &Reference::View,
            false,
            &reference,
        )
    }

    fn read_geometry(&mut self, c: &mut Computed) -> Result<()> {
        let fonts = self.fonts;
        if matches!(c.node.tag_name().name(), "g" | "a" | "text" | "tspan") {
            // Text has lists of coordinates.
            return Ok(());
        }
        for name in LENGTHS {
            let mut slot = None;
            let is_size = matches!(name, "width" | "height" | "r");
            let read = |text: &str, css: bool| match length(text, fonts, !css) {
                _ if is_auto(text) => Value::Is(None),
                Value::Is(Length::Px(v) | Length::Part(v)) if v < 0.0 && is_size => Value::Wrong,
                read => read.map(Some),
            };
            c.take(name, &mut slot, &None, &None, false, &read)?;
            if let Some(length) = slot {
                self.own.lengths.push((name, length));
            }
        }
        if c.node.tag_name().name() != "path" {
            return Ok(());
        }
        let read = |text: &str, css: bool| match css {
            true => css_path(text),
            false => Value::Is(Some(text.to_owned())),
        };
        c.take("d", &mut self.own.path_data, &None, &None, false, &read)
    }

    /// The element's paint with `currentColor` and the context filled in.
    pub fn resolved<'a>(&'a self, paint: &'a Paint) -> &'a Paint {
        match paint {
            Paint::Current => &self.color,
            Paint::Context(false) => &self.context.0,
            Paint::Context(true) => &self.context.1,
            other => other,
        }
    }
}

/// The reading of one element's properties.
struct Computed<'a, 'b> {
    declared: &'a Declared,
    custom: Custom,
    node: Node<'b, 'b>,
    notes: &'a mut Notes,
    /// The first refusal, for an element that shows.
    fault: Option<Rc<str>>,
}

impl Computed<'_, '_> {
    /// Reads a property into `slot`, which holds the value for one that is not declared.
    fn take<T: Clone>(
        &mut self,
        name: &str,
        slot: &mut T,
        parent: &T,
        initial: &T,
        inherited: bool,
        read: &dyn Fn(&str, bool) -> Value<T>,
    ) -> Result<()> {
        match self
            .declared
            .pick(name, &self.custom, self.node, self.notes, false, read)
        {
            Picked::Absent => {}
            Picked::Is(value) => *slot = value,
            Picked::Inherit => *slot = parent.clone(),
            Picked::Unset if inherited => *slot = parent.clone(),
            Picked::Initial | Picked::Unset => *slot = initial.clone(),
            Picked::Unread(text) if matches!(name, "display" | "visibility" | "opacity") => {
                return Err(content_fault(text));
            }
            Picked::Unread(text) => drop(self.fault.get_or_insert(text.into())),
            Picked::Wrong(text) => self
                .notes
                .warn(format!("{text}; it is ignored, as browsers do")),
        }
        Ok(())
    }

    /// Reads a paint. One that is not read is refused only if something is painted with it.
    fn paint(
        &mut self,
        name: &str,
        slot: &mut Paint,
        parent: &Paint,
        initial: &Paint,
        inherited: bool,
        read: &dyn Fn(&str, bool) -> Value<Paint>,
    ) {
        *slot = match self
            .declared
            .pick(name, &self.custom, self.node, self.notes, true, read)
        {
            Picked::Absent => return,
            Picked::Is(value) => value,
            Picked::Inherit => parent.clone(),
            Picked::Unset if inherited => parent.clone(),
            Picked::Initial | Picked::Unset => initial.clone(),
            Picked::Unread(text) => Paint::Fault(text.into()),
            Picked::Wrong(text) => {
                let text = text.replace("which is not valid", "which is no colour");
                Paint::Fault(format!("{text}; write the colour as #rrggbb").into())
            }
        };
    }

    /// Refuses a property of CSS with another value than the `usual` ones, if the element shows.
    fn refuse(&mut self, name: &str, usual: &[&str], remedy: &str) {
        let known = ["", "initial", "unset", "inherit", "auto"];
        let mut usual = usual.iter().chain(&known);
        let unusual = |v: &&str| !usual.any(|u| u.eq_ignore_ascii_case(v));
        if let Some(value) = self.declared.css(name).filter(unusual) {
            let what = format!("\"{name}: {value}\"");
            let text = unsupported(&what, self.node, remedy).to_string();
            self.fault.get_or_insert(text.into());
        }
    }
}

fn words<T: Clone>(list: &[(&'static str, T)]) -> impl Fn(&str, bool) -> Value<T> {
    move |text: &str, _: bool| {
        let found = list
            .iter()
            .find(|(word, _)| text.eq_ignore_ascii_case(word));
        Value::from_option(found.map(|(_, value)| value.clone()))
    }
}

fn paint(text: &str) -> Value<Paint> {
    if let Some((target, fallback)) = url(text) {
        let target = address(target);
        if fallback.is_empty() {
            return Value::Is(Paint::Server(target, None));
        }
        // Only a colour may follow.
        if url(fallback).is_some() {
            return Value::Wrong;
        }
        return paint(fallback).map(|f| Paint::Server(target, Some(Box::new(f))));
    }
    match text.to_ascii_lowercase().as_str() {
        "none" => Value::Is(Paint::None),
        "currentcolor" => Value::Is(Paint::Current),
        "context-fill" => Value::Is(Paint::Context(false)),
        "context-stroke" => Value::Is(Paint::Context(true)),
        _ => color(text).map(Paint::Color),
    }
}

fn address(target: std::result::Result<&str, &str>) -> Target {
    let kept = |text: &str| Rc::from(unescaped(text));
    target.map(kept).map_err(kept)
}

/// Words of `display` that show an element.
fn is_display(word: &str) -> bool {
    let plain = word.split(['-', ' ']).next().unwrap_or_default();
    let known = [
        "inline", "block", "flex", "grid", "table", "list", "flow", "ruby", "run",
    ];
    known.contains(&plain)
}

/// The ground of the page: one colour.
fn ground(text: &str) -> Value<Paint> {
    match paint(text) {
        Value::Wrong => Value::Unread("draw a rectangle of one colour instead"),
        other => other,
    }
}

/// `none` or `url(#name)`.
fn target(text: &str) -> Value<Option<Target>> {
    if text.eq_ignore_ascii_case("none") {
        return Value::Is(None);
    }
    match url(text) {
        Some((target, "")) => Value::Is(Some(address(target))),
        _ => Value::Wrong,
    }
}

/// The order of painting: what is named comes first.
fn order(text: &str) -> Value<[u8; 3]> {
    let text = text.to_ascii_lowercase();
    if text == "normal" {
        return Value::Is([0, 1, 2]);
    }
    let mut order = Vec::new();
    for word in list(&text) {
        match ["fill", "stroke", "markers"]
            .iter()
            .position(|w| *w == word)
        {
            Some(k) if !order.contains(&(k as u8)) => order.push(k as u8),
            _ => return Value::Wrong,
        }
    }
    (0..3).for_each(|k| {
        if !order.contains(&k) {
            order.push(k);
        }
    });
    Value::from_option(order.try_into().ok())
}
