//! Reads the properties of an element into its style, by tables of names, fields and readings.

use crate::css::cascade::Sheets;
use crate::notes::{Notes, Result};
use crate::style::Reference::{Fill, Stroke, View};
use crate::style::reading::Reading;
use crate::style::{Own, Style};
use crate::tree::FillRule;
use crate::value::Unusable::{Unread, Wrong};
use crate::value::color::color;
use crate::value::paint::{Paint, is_display, order, paint, path_data, positive, target, words};
use crate::value::transform::{Base, origin, property, transform};
use crate::value::{alpha, length, list, number};
use kurbo::{Cap, Join};
use roxmltree::Node;
use std::rc::Rc;

/// Names of the attributes that are lengths of shapes.
const LENGTHS: [&str; 13] = [
    "x", "y", "width", "height", "cx", "cy", "r", "rx", "ry", "x1", "y1", "x2", "y2",
];

/// Properties of CSS that are refused with other values than the usual one.
const REFUSED: [(&str, &[&str], &str); 5] = [
    ("mix-blend-mode", &["normal"], "set it to normal"),
    (
        "zoom",
        &["1", "100%", "normal"],
        "scale the drawing instead",
    ),
    ("offset-path", &["none"], "write the place as a transform"),
    ("offset", &["none"], "write the place as a transform"),
    (
        "mask-box-image",
        &["none"],
        "clip with a path, or cut the shape",
    ),
];

/// Reads properties in order. A row has the name, the field of the style, whether it is inherited,
/// and the reading, which gets the text and `true` for one of CSS.
macro_rules! properties {
    ($r:ident $($take:ident $name:literal [$($field:tt)+] $inherited:literal $read:expr;)*) => {$(
        let fields = (&mut $r.style.$($field)+, &$r.parent.$($field)+, &$r.initial.$($field)+);
        $r.reading.$take($name, fields, $inherited, &$read)?;
    )*};
}

impl Style {
    /// The style of an element whose parent has the style `parent`.
    pub fn of(node: Node, parent: &Self, sheets: &Sheets, notes: &mut Notes) -> Result<Self> {
        let declared = sheets.declared(node)?;
        let style = Self {
            custom: declared.custom(&parent.custom)?,
            own: Own::default(),
            ..parent.clone()
        };
        let mut reader = StyleReader {
            reading: Reading {
                custom: Rc::clone(&style.custom),
                fault: declared.fault.as_deref().map(Rc::from),
                declared: &declared,
                node,
                notes,
            },
            style,
            parent,
            initial: Self::default(),
        };
        reader.inherited()?;
        reader.own()?;
        reader.transforms()?;
        reader.geometry()?;
        reader.style.own.fault = reader.reading.fault;
        Ok(reader.style)
    }
}

struct StyleReader<'a, 'b> {
    reading: Reading<'a, 'b>,
    style: Style,
    parent: &'a Style,
    initial: Style,
}

impl StyleReader<'_, '_> {
    fn inherited(&mut self) -> Result<()> {
        let r = self;
        let parent = r.parent.fonts;
        let sizes = words(
            "xx-small x-small small medium large x-large xx-large",
            [9.0, 10.0, 13.0, 16.0, 18.0, 24.0, 32.0],
        );
        let font_size = |text: &str, css: bool| {
            if let Ok(size) = sizes(text, css) {
                return Ok(size);
            }
            match text.to_ascii_lowercase().as_str() {
                "smaller" => Ok(parent.own / 1.2),
                "larger" => Ok(parent.own * 1.2),
                _ => match length(text, parent, !css).map(|l| l.of(parent.own)) {
                    // Fonts matter only to lengths in em.
                    Err(Unread(_)) => Ok(parent.own),
                    other => other,
                },
            }
        };
        properties! { r value "font-size" [fonts.own] true font_size; }
        if r.reading.is_root() {
            r.style.fonts.root = r.style.fonts.own;
        }
        let fonts = r.style.fonts;
        let plain = |text: &str, _: bool| match text.eq_ignore_ascii_case("currentcolor") {
            true => Ok(Paint::Current),
            false => color(text).map(Paint::Color),
        };
        let rule = words("nonzero evenodd", [FillRule::NonZero, FillRule::EvenOdd]);
        let distance = |text: &str, _: bool| length(text, fonts, true);
        let caps = words("butt round square", [Cap::Butt, Cap::Round, Cap::Square]);
        let joins = words("miter round bevel", [Join::Miter, Join::Round, Join::Bevel]);
        let visible = words("visible hidden collapse", [true, false, false]);
        let positive = |text: &str, _: bool| positive(length(text, fonts, true));
        let limit = |text: &str, _: bool| match number(text) {
            Ok(v) if v < 0.0 => Err(Wrong),
            other => other,
        };
        let dashes = |text: &str, css: bool| match text.eq_ignore_ascii_case("none") {
            true => Ok(Vec::new()),
            false if text.split(',').any(|part| part.trim().is_empty()) => Err(Wrong),
            false => list(text)
                .into_iter()
                .map(|part| positive(part, css))
                .collect(),
        };
        properties! { r
            paint "color" [color] true plain;
            paint "fill" [fill] true paint;
            paint "stroke" [stroke] true paint;
            paint "stop-color" [own.stop_color] false plain;
            value "fill-opacity" [fill_opacity] true alpha;
            value "stroke-opacity" [stroke_opacity] true alpha;
            value "stop-opacity" [own.stop_opacity] false alpha;
            value "opacity" [own.opacity] false alpha;
            value "fill-rule" [fill_rule] true rule;
            value "clip-rule" [clip_rule] true rule;
            value "stroke-width" [stroke_width] true positive;
            value "stroke-dashoffset" [dash_offset] true distance;
            value "stroke-linecap" [cap] true caps;
            value "stroke-linejoin" [join] true joins;
            value "stroke-miterlimit" [miter_limit] true limit;
            value "stroke-dasharray" [dashes] true dashes;
            value "paint-order" [order] true order;
            value "visibility" [visible] true visible;
            value "marker-start" [markers[0]] true target;
            value "marker-mid" [markers[1]] true target;
            value "marker-end" [markers[2]] true target;
        }
        if matches!(r.style.color, Paint::Current) {
            r.style.color = r.parent.color.clone();
        }
        Ok(())
    }

    fn own(&mut self) -> Result<()> {
        let r = self;
        let name = r.reading.node.tag_name().name();
        let is_container = matches!(name, "g" | "svg" | "use" | "a" | "switch");
        let display = |text: &str, _: bool| match text.to_ascii_lowercase().as_str() {
            "none" => Ok(false),
            // Shapes have no content of their own.
            "contents" => Ok(is_container),
            word => is_display(word).then_some(true).ok_or(Wrong),
        };
        let clip = |text: &str, css: bool| match target(text, css) {
            Err(Wrong) if text.contains('(') || text.ends_with("-box") => {
                Err(Unread("clip with a <clipPath>"))
            }
            other => other,
        };
        let mask = |text: &str, css: bool| match target(text, css) {
            Err(Wrong) => Err(Unread("clip with a path, or cut the shape")),
            other => other,
        };
        let filter = |text: &str, css: bool| match target(text, css) {
            Err(Wrong) if text.contains('(') => Err(Unread("remove it")),
            other => other,
        };
        let effect = |text: &str, _: bool| Ok(text.eq_ignore_ascii_case("non-scaling-stroke"));
        let overflow = words(
            "visible auto hidden scroll clip",
            [true, true, false, false, false],
        );
        properties! { r
            value "display" [own.display] false display;
            value "clip-path" [own.clip_path] false clip;
            value "mask-image" [own.mask] false mask;
            value "mask" [own.mask] false mask;
            value "backdrop-filter" [own.filter] false filter;
            value "filter" [own.filter] false filter;
            value "vector-effect" [own.vector_effect] false effect;
            value "overflow" [own.overflow] false overflow;
        }
        for (name, usual, remedy) in REFUSED {
            r.reading.refuse(name, usual, remedy);
        }
        for name in ["animation", "animation-name"] {
            if r.reading
                .declared
                .css(name)
                .is_some_and(|v| !v.starts_with("none"))
            {
                let what = "an animation";
                r.reading
                    .notes
                    .warn_at(r.reading.node, what, ", which is drawn at rest");
            }
        }
        if r.reading.is_root() {
            let remedy = "draw a shape of one colour instead";
            r.reading.refuse("background-image", &["none"], remedy);
            let ground = |text: &str, css: bool| match paint(text, css) {
                Err(Wrong) => Err(Unread("draw a rectangle of one colour instead")),
                other => other,
            };
            for name in ["background", "background-color"] {
                if r.reading.declared.css(name).is_some() {
                    let (slot, initial) = (&mut r.style.own.background, &Paint::None);
                    r.reading
                        .value(name, (slot, initial, initial), false, &ground)?;
                }
            }
        }
        Ok(())
    }

    fn transforms(&mut self) -> Result<()> {
        let r = self;
        let fonts = r.style.fonts;
        let base = |css: bool| Base {
            fonts,
            size: (1.0, 1.0),
            css,
        };
        let listed = |text: &str, css: bool| {
            transform(text, base(css)).map(|_| Some((text.to_owned(), css)))
        };
        let place = |text: &str, css: bool| origin(text, base(css)).map(|_| Some(text.to_owned()));
        let reference = words(
            "view-box fill-box content-box stroke-box border-box",
            [View, Fill, Fill, Stroke, Stroke],
        );
        properties! { r value "transform" [own.transform] false listed; }
        for (k, name) in Own::MOVED.into_iter().enumerate() {
            if r.reading.declared.css(name).is_some() {
                let kept = |text: &str, _: bool| {
                    property(text, name, base(true)).map(|_| Some(text.to_owned()))
                };
                let (slot, before) = (&mut r.style.own.moved[k], &r.parent.own.moved[k]);
                r.reading.value(name, (slot, before, &None), false, &kept)?;
            }
        }
        properties! { r
            value "transform-origin" [own.origin] false place;
            value "transform-box" [own.reference] false reference;
        }
        Ok(())
    }

    fn geometry(&mut self) -> Result<()> {
        let r = self;
        let fonts = r.style.fonts;
        let element = r.reading.node.tag_name().name();
        if matches!(element, "g" | "a" | "text" | "tspan") {
            // Text has lists of coordinates.
            return Ok(());
        }
        for name in LENGTHS {
            let mut slot = None;
            let is_size = matches!(name, "width" | "height" | "r");
            let read = |text: &str, css: bool| match length(text, fonts, !css) {
                _ if text.eq_ignore_ascii_case("auto") => Ok(None),
                read if is_size => positive(read).map(Some),
                read => read.map(Some),
            };
            r.reading
                .value(name, (&mut slot, &None, &None), false, &read)?;
            r.style
                .own
                .lengths
                .extend(slot.map(|length| (name, length)));
        }
        if element == "path" {
            let slot = &mut r.style.own.path_data;
            r.reading
                .value("d", (slot, &None, &None), false, &path_data)?;
        }
        Ok(())
    }
}
