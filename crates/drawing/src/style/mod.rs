//! The computed style of an element.

pub(crate) mod properties;
pub(crate) mod reading;

use crate::css::custom::Custom;
use crate::notes::{Fault, Result};
use crate::tree::FillRule;
use crate::value::Target;
use crate::value::color::BLACK;
use crate::value::paint::Paint;
use crate::value::{Fonts, Length};
use kurbo::{Cap, Join};
use std::rc::Rc;

/// Everything that an element inherits, and its own part.
#[derive(Clone, Debug)]
pub(crate) struct Style {
    pub custom: Custom,
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
pub(crate) struct Own {
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
    pub lengths: Vec<(&'static str, Length)>,
    /// The data of a path.
    pub path_data: Option<String>,
}

/// The box that a transform refers to.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Reference {
    View,
    Fill,
    Stroke,
}

impl Own {
    /// The properties of `moved`.
    pub const MOVED: [&str; 3] = ["translate", "rotate", "scale"];

    /// # Errors
    /// If a property is not read.
    pub fn check(&self) -> Result<()> {
        match &self.fault {
            Some(text) => Err(Fault::new(&**text)),
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

    /// A length of the geometry in user units, 0 if it is not given.
    pub fn size(&self, name: &str, whole: f64) -> f64 {
        self.geometry(name).map_or(0.0, |l| l.of(whole))
    }

    /// The paints for markers and symbols that this element uses.
    pub fn as_context(&self) -> Rc<(Paint, Paint)> {
        let [fill, stroke] = [&self.fill, &self.stroke].map(|p| self.resolved(p).clone());
        Rc::new((fill, stroke))
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
