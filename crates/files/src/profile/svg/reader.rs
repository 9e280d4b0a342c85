//! Walks the elements that show, follows their references, and makes plain painted paths of them.

use super::super::paint::{self, Rgba};
use super::cascade::Sheets;
use super::color::Color;
use super::notes::{Notes, misled, unsupported};
use super::shapes::{Curve, crossings, curve};
use super::style::{Own, Paint, Reference, Style, Target};
use super::transform::{Base, origin, rotate, scale, transform, translate};
use super::tree::{Band, Clip, ClipShape, Group, Node as Drawn, Path, bounds, is_painted};
use super::value::{Value, attribute};
use super::viewport::{fitted, view_box};
use crate::content_fault;
use kurbo::{Affine, BezPath, Cap, Rect, Shape, Stroke, Vec2};
use revmap::error::{Error, Result};
use revmap::profile::{FillRule, Profile};
use roxmltree::{Node, NodeId};
use std::collections::HashMap;
use std::rc::Rc;

/// Groups and references may be nested this deep.
const MOST_NESTED: usize = 200;
/// Most elements of a drawing after references are followed.
const MOST_ELEMENTS: usize = 200_000;
/// Most crossings of a path with itself.
const MOST_CROSSINGS: f64 = 1.5e5;
/// References from gradient to gradient.
const MOST_LINKS: usize = 32;

pub(super) const SVG: &str = "http://www.w3.org/2000/svg";
const XLINK: &str = "http://www.w3.org/1999/xlink";
pub(super) const XHTML: &str = "http://www.w3.org/1999/xhtml";

/// Elements of SVG that show nothing where they are.
const UNSEEN: [&str; 33] = [
    "defs",
    "symbol",
    "clipPath",
    "mask",
    "linearGradient",
    "radialGradient",
    "pattern",
    "marker",
    "filter",
    "style",
    "title",
    "desc",
    "metadata",
    "view",
    "font",
    "font-face",
    "cursor",
    "color-profile",
    "hatch",
    "hatchpath",
    "mesh",
    "meshgradient",
    "solidcolor",
    "solidColor",
    "stop",
    "tspan",
    "textPath",
    "tref",
    "glyph",
    "missing-glyph",
    "mpath",
    "meshGradient",
    "namedview",
];

/// A colour, or the darkest and the lightest of a gradient.
type Shade = (Rgba, Option<Rgba>);

/// Where an element is: what percentages refer to, and how deep.
#[derive(Clone, Copy)]
pub(super) struct Place {
    pub viewport: (f64, f64),
    pub depth: usize,
    /// False within what is transparent: only the boxes of shapes count there.
    pub shown: bool,
}

impl Place {
    pub fn within(viewport: (f64, f64)) -> Self {
        Self {
            viewport,
            depth: 0,
            shown: true,
        }
    }

    pub fn deeper(self) -> Self {
        Self {
            depth: self.depth + 1,
            ..self
        }
    }
}

pub(super) struct Reader<'a> {
    sheets: Sheets,
    ids: HashMap<&'a str, Node<'a, 'a>>,
    pub notes: Notes,
    /// Elements whose content is being read through a reference.
    pub open: Vec<NodeId>,
    /// Clips that were read, by their element and what their lengths refer to.
    clips: HashMap<(NodeId, [u64; 6]), Clip>,
    count: usize,
}

impl<'a> Reader<'a> {
    pub fn new(document: &'a roxmltree::Document<'a>) -> Self {
        let mut notes = Notes::of(document);
        let mut ids = HashMap::new();
        for node in document.descendants() {
            warn_of_motion(node, &mut notes);
            if let Some(id) = attribute(node, "id") {
                ids.entry(id).or_insert(node);
            }
        }
        Self {
            sheets: Sheets::of(document, &mut notes),
            ids,
            notes,
            open: Vec::new(),
            clips: HashMap::new(),
            count: 0,
        }
    }

    pub fn by_id(&self, id: &str) -> Option<Node<'a, 'a>> {
        let found = self.ids.get(id).or_else(|| {
            let plain = percent_decoded(id)?;
            self.ids.get(plain.as_str())
        });
        found.copied()
    }

    /// The style of an element where it is in the document.
    pub fn style_of(&mut self, node: Node) -> Result<Box<Style>> {
        let mut ancestors: Vec<Node> = node.ancestors().filter(Node::is_element).collect();
        ancestors.reverse();
        let start = Box::new(Style::default());
        ancestors.into_iter().try_fold(start, |parent, n| {
            let mut style = self.styled(n, &parent)?;
            style.own.fault = style.own.fault.or(parent.own.fault);
            Ok(style)
        })
    }

    /// The style of an element within another. Boxes keep the stack of nested elements small.
    #[inline(never)]
    pub fn styled(&mut self, node: Node, parent: &Style) -> Result<Box<Style>> {
        Style::of(node, parent, &self.sheets, &mut self.notes).map(Box::new)
    }

    pub fn children(
        &mut self,
        node: Node<'a, 'a>,
        style: &Style,
        place: Place,
        out: &mut Vec<Drawn>,
    ) -> Result<()> {
        for child in node.children().filter(Node::is_element) {
            self.element(child, style, place.deeper(), out)?;
        }
        Ok(())
    }

    fn element(
        &mut self,
        node: Node<'a, 'a>,
        parent: &Style,
        place: Place,
        out: &mut Vec<Drawn>,
    ) -> Result<()> {
        if !is_svg(node) || !self.is_seen(node) {
            return Ok(());
        }
        self.counted()?;
        if place.depth > MOST_NESTED {
            let what = format!("elements nested more than {MOST_NESTED} deep");
            return Err(misled(&what, node, "too many", "ungroup them"));
        }
        let style = self.styled(node, parent)?;
        if !style.own.display {
            return Ok(());
        }
        let hidden = style.own.opacity <= 0.0 || self.vanishes(node, &style, place)?;
        let place = Place {
            shown: place.shown && !hidden,
            ..place
        };
        let open = self.open.len();
        match self.shown(node, &style, place, out) {
            Err(_) if !place.shown => {
                self.open.truncate(open);
                Ok(())
            }
            other => other,
        }
    }

    /// Counts one more element.
    fn counted(&mut self) -> Result<()> {
        self.count += 1;
        match self.count > MOST_ELEMENTS {
            true => Err(content_fault(format!(
                "the drawing has more than {MOST_ELEMENTS} elements, those of clips and references included; simplify it"
            ))),
            false => Ok(()),
        }
    }

    /// Returns true if an element is scaled to nothing, or clipped by an empty clip.
    #[inline(never)]
    fn vanishes(&mut self, node: Node, style: &Style, place: Place) -> Result<bool> {
        let target = style.own.clip_path.as_ref();
        let clip = target
            .and_then(|t| t.as_ref().ok())
            .and_then(|id| self.by_id(id));
        let is_empty =
            |n: Node| n.tag_name().name() == "clipPath" && n.first_element_child().is_none();
        let is_box = style.own.reference == Reference::Stroke;
        Ok(clip.is_some_and(is_empty)
            || (!is_box && self.transform(node, style, place, &[])?.determinant() == 0.0))
    }

    /// Adds an element that is displayed.
    fn shown(
        &mut self,
        node: Node<'a, 'a>,
        style: &Style,
        place: Place,
        out: &mut Vec<Drawn>,
    ) -> Result<()> {
        let mut content = Vec::new();
        match node.tag_name().name() {
            "g" | "a" => self.children(node, style, place, &mut content)?,
            "svg" => self.viewport(node, node, style, place, &mut content)?,
            "use" => self.reference(node, style, place, &mut content)?,
            "switch" => {
                let first = node.children().find(|n| is_svg(*n) && passes(*n));
                if let Some(child) = first {
                    self.element(child, style, place.deeper(), &mut content)?;
                }
            }
            "path" | "rect" | "circle" | "ellipse" | "line" | "polyline" | "polygon" => {
                self.shape(node, style, place, &mut content)?;
            }
            name => return self.without_outline(node, name, style, place),
        }
        self.wrap(node, style, place, content, out)
    }

    /// Returns false for elements that show nothing, with a warning if something may be missing.
    fn is_seen(&mut self, node: Node) -> bool {
        let name = node.tag_name().name();
        let known = [
            "g",
            "a",
            "svg",
            "use",
            "switch",
            "path",
            "rect",
            "circle",
            "ellipse",
            "line",
            "polyline",
            "polygon",
            "text",
            "image",
            "foreignObject",
            "flowRoot",
        ];
        if known.contains(&name) {
            return passes(node);
        }
        if !(UNSEEN.contains(&name) || name.starts_with("fe") || is_motion(name)) {
            self.notes.warn(format!(
                "the drawing has <{name}> (line {}): an element that SVG does not have, which is left out",
                self.notes.line(node)
            ));
        }
        false
    }

    /// Refuses elements that have no outline here, if they show.
    #[inline(never)]
    fn without_outline(
        &mut self,
        node: Node,
        name: &str,
        style: &Style,
        place: Place,
    ) -> Result<()> {
        if !place.shown {
            return Ok(());
        }
        let sized = || {
            let side = |name: &str, whole: f64| style.geometry(name).map(|l| l.of(whole));
            let (w, h) = (
                side("width", place.viewport.0),
                side("height", place.viewport.1),
            );
            (w, h)
        };
        let remedy = match name {
            "text" | "flowRoot" => {
                if !self.text_shows(node, style, place.depth)? {
                    return Ok(());
                }
                "convert it to paths, or hide a label by display=\"none\""
            }
            "image" => {
                let (w, h) = sized();
                if !style.visible || href(node).is_none() || w == Some(0.0) || h == Some(0.0) {
                    return Ok(());
                }
                "trace it to paths"
            }
            _ => {
                let (w, h) = sized();
                let shown = |v: Option<f64>| v.is_some_and(|v| v > 0.0);
                let filled = node
                    .children()
                    .any(|c| c.is_element() || c.text().is_some_and(|t| !t.trim().is_empty()));
                if !style.visible || !filled || !shown(w) || !shown(h) {
                    return Ok(());
                }
                "convert it to paths, or hide a label by display=\"none\""
            }
        };
        Err(unsupported(&format!("<{name}>"), node, remedy))
    }

    /// Returns true if text has letters that are painted.
    fn text_shows(&mut self, node: Node, style: &Style, depth: usize) -> Result<bool> {
        let painted = |paint: &Paint, opacity: f32| {
            opacity > 0.0 && !matches!(style.resolved(paint), Paint::None)
        };
        let shown = style.visible
            && style.fonts.own > 0.0
            && (painted(&style.fill, style.fill_opacity)
                || painted(&style.stroke, style.stroke_opacity));
        let letters = |n: &Node| n.is_text() && n.text().is_some_and(|t| !t.trim().is_empty());
        if shown && node.children().any(|n| letters(&n)) {
            return Ok(true);
        }
        if depth > MOST_NESTED {
            return Ok(true);
        }
        let described = |n: &Node| matches!(n.tag_name().name(), "title" | "desc" | "metadata");
        let children = node.children().filter(Node::is_element);
        for child in children.filter(|n| !described(n)) {
            let own = self.styled(child, style)?;
            if own.own.display
                && own.own.opacity > 0.0
                && self.text_shows(child, &own, depth + 1)?
            {
                return Ok(true);
            }
        }
        Ok(false)
    }

    /// The content of an `svg` or `symbol`, whose place and size `frame` may give.
    fn viewport(
        &mut self,
        node: Node<'a, 'a>,
        frame: Node<'a, 'a>,
        style: &Style,
        place: Place,
        out: &mut Vec<Drawn>,
    ) -> Result<()> {
        let of_frame = match frame == node {
            true => Box::new(style.clone()),
            false => self.style_of(frame)?,
        };
        let (width, height) = place.viewport;
        let side = |name: &str, whole: f64| {
            let given = of_frame.geometry(name).or_else(|| style.geometry(name));
            given.map_or(whole, |l| l.of(whole))
        };
        let size = (side("width", width), side("height", height));
        if !(size.0 > 0.0 && size.1 > 0.0) {
            return Ok(());
        }
        let corner = |name: &str, whole: f64| style.geometry(name).map_or(0.0, |l| l.of(whole));
        let is_svg = node.tag_name().name() == "svg";
        let at = match is_svg {
            true => Vec2::new(corner("x", width), corner("y", height)),
            false => Vec2::ZERO,
        };
        let inner = view_box(node, &mut self.notes);
        if inner.is_some_and(|i| i.area() <= 0.0) {
            return Ok(());
        }
        let fit = inner.map_or(Affine::IDENTITY, |i| fitted(node, i, size));
        let viewport = inner.map_or(size, |i| (i.width(), i.height()));
        let mut children = Vec::new();
        let within = Place { viewport, ..place };
        self.children(node, style, within, &mut children)?;
        if children.is_empty() {
            return Ok(());
        }
        let clip =
            (!style.own.overflow).then(|| Clip::to_rect(Rect::new(0.0, 0.0, size.0, size.1)));
        let inner = Drawn::Group(Group::moved(fit, children));
        out.push(Drawn::Group(Group {
            clip,
            ..Group::moved(Affine::translate(at), vec![inner])
        }));
        Ok(())
    }

    /// The content of a `use`.
    fn reference(
        &mut self,
        node: Node<'a, 'a>,
        style: &Style,
        place: Place,
        out: &mut Vec<Drawn>,
    ) -> Result<()> {
        let Some(target) = self.used(node)? else {
            return Ok(());
        };
        let mut inherited = Box::new(style.clone());
        inherited.context = Rc::new((
            style.resolved(&style.fill).clone(),
            style.resolved(&style.stroke).clone(),
        ));
        let mut children = Vec::new();
        self.open.push(target.id());
        match target.tag_name().name() {
            "symbol" | "svg" => {
                let own = self.styled(target, &inherited)?;
                if own.own.display && passes(target) {
                    let mut content = Vec::new();
                    self.viewport(target, node, &own, place.deeper(), &mut content)?;
                    self.wrap(target, &own, place, content, &mut children)?;
                }
            }
            _ => self.element(target, &inherited, place.deeper(), &mut children)?,
        }
        self.open.pop();
        if !children.is_empty() {
            let (width, height) = place.viewport;
            let at = |name: &str, whole: f64| style.geometry(name).map_or(0.0, |l| l.of(whole));
            let moved = Affine::translate((at("x", width), at("y", height)));
            out.push(Drawn::Group(Group::moved(moved, children)));
        }
        Ok(())
    }

    /// The element that a `use` refers to.
    fn used(&mut self, node: Node) -> Result<Option<Node<'a, 'a>>> {
        let Some(address) = href(node) else {
            return Ok(None);
        };
        let what = format!("<use href=\"{}\">", super::css::one_line(address));
        let Some(id) = address.strip_prefix('#') else {
            return Err(misled(
                &what,
                node,
                "whose part is in another file",
                "copy the part into the drawing",
            ));
        };
        let Some(target) = self.by_id(id) else {
            return Err(misled(
                &what,
                node,
                "whose part is not in the drawing",
                "add the part or remove the element",
            ));
        };
        if self.open.contains(&target.id()) {
            return Err(misled(
                &what,
                node,
                "which contains itself",
                "remove the inner one",
            ));
        }
        Ok(Some(target))
    }

    #[inline(never)]
    fn shape(
        &mut self,
        node: Node<'a, 'a>,
        style: &Style,
        place: Place,
        out: &mut Vec<Drawn>,
    ) -> Result<()> {
        let plain = |curve: &BezPath| Path {
            curve: curve.clone(),
            band: None,
            rule: style.fill_rule,
            color: [0.0; 4],
            lightest: None,
        };
        if !style.visible || !place.shown {
            let curve = curve(node, style, place.viewport).path;
            if curve.is_finite() {
                out.push(Drawn::Path(plain(&curve)));
            }
            return Ok(());
        }
        style.own.check()?;
        let curve = self.curve(node, style, place)?;
        if curve.path.elements().len() < 2 {
            return Ok(());
        }
        let bounds = curve.path.bounding_box();
        let has_inside = bounds.area() > 0.0 && node.tag_name().name() != "line";
        let (width, height) = place.viewport;
        let diagonal = (0.5 * (width * width + height * height)).sqrt();
        let thickness = style.stroke_width.of(diagonal);
        let mut painted = false;
        for part in style.order {
            let (shade, opacity) = match part {
                0 if has_inside => (&style.fill, style.fill_opacity),
                1 if thickness > 0.0 => (&style.stroke, style.stroke_opacity),
                0 | 1 => continue,
                _ => {
                    self.markers(node, style, place, &curve, thickness, out)?;
                    continue;
                }
            };
            let Some((color, lightest)) = self.solid(shade, opacity, style, bounds, node)? else {
                continue;
            };
            painted = true;
            let shape = match part {
                1 => stroked(node, style, &curve, thickness, diagonal)?,
                _ => plain(&curve.path),
            };
            out.push(Drawn::Path(Path {
                color,
                lightest: lightest.map(|color| (color, self.notes.line(node))),
                ..shape
            }));
        }
        if !painted {
            out.push(Drawn::Path(plain(&curve.path)));
        }
        Ok(())
    }

    fn curve(&mut self, node: Node, style: &Style, place: Place) -> Result<Curve> {
        let curve = curve(node, style, place.viewport);
        if let Some(mistake) = &curve.mistake {
            self.notes.warn(format!(
                "the drawing has {mistake} (line {}); the path ends there, as in browsers",
                self.notes.line(node)
            ));
        }
        let crossings = crossings(&curve.path);
        if crossings > MOST_CROSSINGS {
            let what = format!("a path that crosses itself about {crossings:.0} times");
            return Err(misled(&what, node, "which is too often", "simplify it"));
        }
        match curve.path.is_finite() {
            true => Ok(curve),
            false => Err(misled(
                "a coordinate",
                node,
                "which is beyond all numbers",
                "correct it",
            )),
        }
    }

    /// The colour of a paint, premultiplied, with the lightest one of a gradient.
    fn solid(
        &mut self,
        paint: &Paint,
        opacity: f32,
        style: &Style,
        bounds: Rect,
        node: Node,
    ) -> Result<Option<Shade>> {
        if opacity <= 0.0 {
            return Ok(None);
        }
        let (target, fallback) = match style.resolved(paint) {
            Paint::None | Paint::Current | Paint::Context(_) => return Ok(None),
            Paint::Color(color) => return Ok(Some((premultiplied(*color, opacity), None))),
            Paint::Fault(text) => return Err(content_fault(text.to_string())),
            Paint::Server(target, fallback) => (target.clone(), fallback.clone()),
        };
        let found = target.as_ref().ok().and_then(|id| self.by_id(id));
        match found.map(|n| n.tag_name().name()) {
            Some("pattern") => {
                return Err(unsupported(
                    "a pattern",
                    node,
                    "give the shape one flat colour",
                ));
            }
            Some("linearGradient" | "radialGradient") => {
                if let Some(gradient) = found
                    && let Some(color) = self.gradient(gradient, opacity, bounds)?
                {
                    return Ok(Some(color));
                }
            }
            _ if fallback.is_none() => {
                let (Ok(id) | Err(id)) = &target;
                let what = format!("a paint \"{id}\"");
                return Err(misled(
                    &what,
                    node,
                    "which is not in it",
                    "give the shape one flat colour",
                ));
            }
            _ => {}
        }
        match fallback {
            Some(paint) => self.solid(&paint, opacity, style, bounds, node),
            None => Ok(None),
        }
    }

    /// The colours of a gradient's stops; `None` for a gradient that paints nothing.
    fn gradient(
        &mut self,
        gradient: Node<'a, 'a>,
        opacity: f32,
        bounds: Rect,
    ) -> Result<Option<Shade>> {
        let (mut stops, mut units, mut at) = (Vec::new(), None, Some(gradient));
        for _ in 0..MOST_LINKS {
            let Some(n) = at else { break };
            let is_stop = |n: &Node| n.is_element() && n.tag_name().name() == "stop";
            if stops.is_empty() {
                stops = n.children().filter(is_stop).collect();
            }
            units = units.or_else(|| attribute(n, "gradientUnits"));
            at = href(n)
                .and_then(|h| h.strip_prefix('#'))
                .and_then(|id| self.by_id(id));
        }
        let flat = bounds.width() <= 0.0 || bounds.height() <= 0.0;
        if flat && units != Some("userSpaceOnUse") {
            return Ok(None);
        }
        let mut colors = Vec::new();
        for stop in stops {
            let style = self.style_of(stop)?;
            style.own.check()?;
            let alpha = style.own.stop_opacity * opacity;
            match style.resolved(&style.own.stop_color) {
                Paint::Color(color) => colors.push(premultiplied(*color, alpha)),
                Paint::Fault(text) => return Err(content_fault(text.to_string())),
                _ => {}
            }
        }
        Ok(paint::bounds(&colors))
    }

    /// Adds an element's content under its transform, clip and opacity.
    #[inline(never)]
    pub fn wrap(
        &mut self,
        node: Node<'a, 'a>,
        style: &Style,
        place: Place,
        content: Vec<Drawn>,
        out: &mut Vec<Drawn>,
    ) -> Result<()> {
        if content.is_empty() {
            return Ok(());
        }
        let is_painted = place.shown && is_painted(&content);
        if is_painted {
            style.own.check()?;
            self.refuse_effects(node, &style.own)?;
        }
        let transform = self.transform(node, style, place, &content)?;
        if transform.determinant() == 0.0 {
            return Ok(());
        }
        let clip = match style.own.clip_path.as_ref().filter(|_| is_painted) {
            Some(target) => {
                let target = target.clone();
                let mut clip =
                    self.clip(&target, node, place, bounds(&content, Affine::IDENTITY))?;
                if let Some(clip) = &mut clip {
                    clip.crop(&content);
                    self.count += clip.size();
                }
                clip
            }
            None => None,
        };
        if transform == Affine::IDENTITY && clip.is_none() && style.own.opacity >= 1.0 {
            out.extend(content);
        } else {
            out.push(Drawn::Group(Group {
                opacity: style.own.opacity,
                clip,
                ..Group::moved(transform, content)
            }));
        }
        Ok(())
    }

    /// Refuses masks and filters. Browsers ignore those that are missing.
    fn refuse_effects(&mut self, node: Node, own: &Own) -> Result<()> {
        for (name, target) in [("mask", &own.mask), ("filter", &own.filter)] {
            let Some(target) = target else { continue };
            let found = target.as_ref().ok().and_then(|id| self.by_id(id));
            let is_here = found.is_some_and(|n| n.tag_name().name() == name);
            if is_here || (target.is_err() && name == "mask") {
                let remedy = match name {
                    "mask" => "clip with a path, or cut the shape",
                    _ => "remove it",
                };
                return Err(unsupported(&format!("a {name}"), node, remedy));
            }
            let (Ok(id) | Err(id)) = target;
            self.missing(name, id, node);
        }
        Ok(())
    }

    fn missing(&mut self, name: &str, id: &str, node: Node) {
        self.notes.warn(format!(
            "the drawing has a {name} \"{id}\" (line {}), which is not in it and is ignored, as in browsers",
            self.notes.line(node)
        ));
    }

    /// The transform of an element, from its attribute and from CSS.
    fn transform(
        &mut self,
        node: Node,
        style: &Style,
        place: Place,
        content: &[Drawn],
    ) -> Result<Affine> {
        let own = &style.own;
        if own.transform.is_none() && own.moved.iter().all(Option::is_none) {
            return Ok(Affine::IDENTITY);
        }
        let (mut corner, mut size) = (Vec2::ZERO, place.viewport);
        match own.reference {
            Reference::View => {}
            Reference::Stroke => {
                return Err(unsupported(
                    "\"transform-box: stroke-box\"",
                    node,
                    "use fill-box",
                ));
            }
            Reference::Fill => {
                let about = bounds(content, Affine::IDENTITY).unwrap_or_default();
                (corner, size) = (about.origin().to_vec2(), (about.width(), about.height()));
            }
        }
        let css = Base {
            fonts: style.fonts,
            size,
            css: true,
        };
        // Values were read once with the style, so that all are valid.
        let mut product = Affine::IDENTITY;
        type Read = fn(&str, Base) -> Value<Affine>;
        let reads: [Read; 3] = [translate, rotate, scale];
        for (text, read) in own.moved.iter().zip(reads) {
            if let Some(factor) = text.as_deref().and_then(|t| read(t, css).ok()) {
                product *= factor;
            }
        }
        if let Some((text, is_css)) = &own.transform {
            let base = Base {
                css: *is_css,
                ..css
            };
            product *= transform(text, base).ok().unwrap_or_default();
        }
        let usual = match node.parent_element() {
            Some(_) => Vec2::ZERO,
            None => Vec2::new(0.5 * size.0, 0.5 * size.1),
        };
        let plain = Base { css: false, ..css };
        let about = own.origin.as_deref().and_then(|t| origin(t, plain).ok());
        let about = corner + about.unwrap_or(usual);
        Ok(Affine::translate(about) * product * Affine::translate(-about))
    }

    /// The clip that is referred to. Browsers ignore one that is missing.
    fn clip(
        &mut self,
        target: &Target,
        node: Node,
        place: Place,
        about: Option<Rect>,
    ) -> Result<Option<Clip>> {
        let found = target.as_ref().ok().and_then(|id| self.by_id(id));
        let Some(clip) = found.filter(|n| n.tag_name().name() == "clipPath") else {
            let (Ok(id) | Err(id)) = target;
            self.missing("clip", id, node);
            return Ok(None);
        };
        if self.open.contains(&clip.id()) {
            return Err(misled(
                "a clip",
                clip,
                "which clips itself",
                "remove the inner one",
            ));
        }
        if self.open.len() > MOST_NESTED {
            return Err(misled(
                "a clip",
                clip,
                "which is nested too deep",
                "remove the inner ones",
            ));
        }
        let style = self.style_of(clip)?;
        style.own.check()?;
        let is_of_box = attribute(clip, "clipPathUnits") == Some("objectBoundingBox");
        let known = about.filter(|_| is_of_box || style.own.clip_path.is_some());
        let known = known.unwrap_or_default();
        let (width, height) = place.viewport;
        let key = [width, height, known.x0, known.y0, known.x1, known.y1].map(f64::to_bits);
        if let Some(read) = self.clips.get(&(clip.id(), key)) {
            return Ok(Some(read.clone()));
        }
        self.open.push(clip.id());
        let (mut place, mut to_box) = (place, Affine::IDENTITY);
        if is_of_box {
            let about = about.unwrap_or_default();
            to_box = Affine::new([about.width(), 0.0, 0.0, about.height(), about.x0, about.y0]);
            place.viewport = (1.0, 1.0);
        }
        let mut shapes = Vec::new();
        for child in clip.children().filter(Node::is_element) {
            self.clip_shape(child, &style, place, Affine::IDENTITY, &mut shapes)?;
        }
        let transform = to_box * self.transform(clip, &style, place, &[])?;
        let within = match &style.own.clip_path {
            Some(target) => self
                .clip(&target.clone(), clip, place, about)?
                .map(Box::new),
            None => None,
        };
        self.open.pop();
        let read = Clip {
            transform,
            shapes,
            within,
        };
        self.clips.insert((clip.id(), key), read.clone());
        Ok(Some(read))
    }

    fn clip_shape(
        &mut self,
        node: Node<'a, 'a>,
        parent: &Style,
        place: Place,
        outer: Affine,
        shapes: &mut Vec<ClipShape>,
    ) -> Result<()> {
        let name = node.tag_name().name();
        let shape = [
            "path", "rect", "circle", "ellipse", "line", "polyline", "polygon",
        ]
        .contains(&name);
        if !is_svg(node) || !(shape || matches!(name, "use" | "text")) || !passes(node) {
            return Ok(());
        }
        self.counted()?;
        let style = self.styled(node, parent)?;
        if !style.own.display || (name != "use" && !style.visible) {
            return Ok(());
        }
        style.own.check()?;
        if name == "text" {
            return match self.text_shows(node, &style, place.depth)? {
                true => Err(unsupported(
                    "a clip that is no path",
                    node,
                    "clip with a path",
                )),
                false => Ok(()),
            };
        }
        if name == "use" {
            let Some(target) = self.used(node)? else {
                return Ok(());
            };
            // A `use` in a clip refers to a shape directly.
            if matches!(target.tag_name().name(), "g" | "use" | "svg" | "symbol") {
                return Ok(());
            }
            let (width, height) = place.viewport;
            let at = |name: &str, whole: f64| style.geometry(name).map_or(0.0, |l| l.of(whole));
            let own = self.transform(node, &style, place, &[])?;
            let moved = outer * own * Affine::translate((at("x", width), at("y", height)));
            let first = shapes.len();
            self.open.push(target.id());
            self.clip_shape(target, &style, place, moved, shapes)?;
            self.open.pop();
            return self.clip_shapes(&style, node, place, outer * own, &mut shapes[first..]);
        }
        let mut curve = self.curve(node, &style, place)?.path;
        let content = [Drawn::Path(Path {
            curve: curve.clone(),
            band: None,
            rule: style.clip_rule,
            color: [0.0; 4],
            lightest: None,
        })];
        let own = outer * self.transform(node, &style, place, &content)?;
        curve.apply_affine(own);
        let first = shapes.len();
        shapes.push(ClipShape {
            curve,
            rule: style.clip_rule,
            clip: None,
        });
        self.clip_shapes(&style, node, place, own, &mut shapes[first..])
    }

    /// Cuts the shapes of a clip by the clip of an element in it.
    fn clip_shapes(
        &mut self,
        style: &Style,
        node: Node<'a, 'a>,
        place: Place,
        transform: Affine,
        shapes: &mut [ClipShape],
    ) -> Result<()> {
        let Some(target) = style.own.clip_path.clone() else {
            return Ok(());
        };
        for shape in shapes {
            let about = transform.inverse() * &shape.curve;
            let about = (!about.is_empty()).then(|| about.bounding_box());
            let Some(mut clip) = self.clip(&target, node, place, about)? else {
                return Ok(());
            };
            self.count += clip.size();
            self.counted()?;
            clip.transform = transform * clip.transform;
            clip.within = match (clip.within.take(), shape.clip.take()) {
                (within, None) => within,
                (None, Some(before)) => Some(Box::new(before)),
                (Some(_), Some(_)) => {
                    return Err(unsupported(
                        "clips of clips of clips",
                        node,
                        "clip with one path",
                    ));
                }
            };
            shape.clip = Some(clip);
        }
        Ok(())
    }
}

pub(super) fn premultiplied([r, g, b, alpha]: Color, opacity: f32) -> Rgba {
    let a = alpha * opacity;
    [r * a, g * a, b * a, a]
}

/// The path that an element's stroke covers, without its colour.
fn stroked(node: Node, style: &Style, curve: &Curve, width: f64, diagonal: f64) -> Result<Path> {
    if width > Profile::EXTENT * diagonal {
        let what = format!("a stroke {width} wide");
        return Err(unsupported(&what, node, "draw a rectangle instead"));
    }
    let band = band(node, style, curve, width, diagonal)?;
    let mut path = Path {
        curve: curve.path.clone(),
        band: None,
        rule: FillRule::NonZero,
        color: [0.0; 4],
        lightest: None,
    };
    let bounds = curve.path.bounding_box();
    let is_round = matches!(node.tag_name().name(), "circle" | "ellipse");
    let is_full = width >= bounds.width().min(bounds.height());
    if is_round && is_full && band.style.dash_pattern.is_empty() && !band.on_page {
        // The inner border would be turned inside out.
        path.curve = outer_border(bounds, 0.5 * width);
        return Ok(path);
    }
    path.band = Some(band);
    Ok(path)
}

/// The curve at this distance outside of the ellipse in a box.
fn outer_border(bounds: Rect, distance: f64) -> BezPath {
    const CORNERS: u32 = 2048;
    let (rx, ry) = (0.5 * bounds.width(), 0.5 * bounds.height());
    let mut border = BezPath::new();
    for k in 0..CORNERS {
        let (sin, cos) = (std::f64::consts::TAU * f64::from(k) / f64::from(CORNERS)).sin_cos();
        let out = Vec2::new(ry * cos, rx * sin).normalize() * distance;
        let p = bounds.center() + Vec2::new(rx * cos, ry * sin) + out;
        match k {
            0 => border.move_to(p),
            _ => border.line_to(p),
        }
    }
    border.close_path();
    border
}

/// Most dashes of a stroke, and most pairs of round or square ones that overlap.
const MOST_DASHES: f64 = 2e4;
const MOST_OVERLAPS: f64 = 2e5;
/// Gaps between round or square dashes of at most this part of the width are closed.
const CLOSED_GAP: f64 = 2.5e-3;

/// The shape of an element's stroke.
fn band(node: Node, style: &Style, curve: &Curve, width: f64, diagonal: f64) -> Result<Band> {
    let mut dashes: Vec<f64> = style.dashes.iter().map(|d| d.of(diagonal)).collect();
    let mut offset = style.dash_offset.of(diagonal);
    if dashes.iter().sum::<f64>() <= 0.0 {
        dashes.clear();
    }
    if dashes.len() % 2 == 1 {
        dashes.extend_from_within(..);
    }
    let stated = attribute(node, "pathLength").and_then(|t| t.trim().parse::<f64>().ok());
    if let Some(stated) = stated.filter(|v| *v > 0.0 && !dashes.is_empty()) {
        let factor = curve.path.perimeter(1e-3 * width) / stated;
        dashes.iter_mut().for_each(|d| *d *= factor);
        offset *= factor;
    }
    let mut gaps = dashes.iter().skip(1).step_by(2);
    if style.cap != Cap::Butt && gaps.all(|gap| *gap <= CLOSED_GAP * width) {
        dashes.clear();
    }
    if !dashes.is_empty() {
        check_dashes(node, style, curve, width, &dashes)?;
    }
    let stroke = Stroke::new(width)
        .with_miter_limit(style.miter_limit)
        .with_caps(style.cap)
        .with_join(style.join);
    Ok(Band {
        style: stroke.with_dashes(offset, dashes),
        on_page: style.own.vector_effect,
    })
}

/// Refuses strokes with more dashes than can be seen.
fn check_dashes(
    node: Node,
    style: &Style,
    curve: &Curve,
    width: f64,
    dashes: &[f64],
) -> Result<()> {
    let period = dashes.iter().sum::<f64>() / (0.5 * dashes.len() as f64);
    let count = curve.path.perimeter(1e-3 * width.max(period)) / period;
    let overlaps = match style.cap {
        Cap::Butt => 0.0,
        _ => count * (width / period).floor(),
    };
    if count <= MOST_DASHES && overlaps <= MOST_OVERLAPS {
        return Ok(());
    }
    let what = format!("a stroke of {count:.0} dashes");
    Err(misled(
        &what,
        node,
        "which are too many",
        "make them longer",
    ))
}

/// Warns of scripts and animations, wherever they are.
fn warn_of_motion(node: Node, notes: &mut Notes) {
    let name = node.tag_name().name();
    let is_html = node.tag_name().namespace() == Some(XHTML);
    let rest = match name {
        "link" if is_html && attribute(node, "rel") == Some("stylesheet") => {
            return notes.warn(
                "the drawing has a style sheet in another file, which is not read; copy the rules into the drawing"
                    .to_owned(),
            );
        }
        "script" if (is_svg(node) || is_html) && runs(node) => "a script, which is not run",
        _ if !is_svg(node) => return,
        _ if is_motion(name) => "an animation, which is drawn at rest",
        _ if attribute(node, "onload").is_some() => "a script on loading, which is not run",
        _ => return,
    };
    notes.warn(format!(
        "the drawing has <{name}> (line {}): {rest}",
        notes.line(node)
    ));
}

fn runs(script: Node) -> bool {
    let has_text = script.text().is_some_and(|t| !t.trim().is_empty());
    has_text || href(script).is_some() || attribute(script, "src").is_some()
}

fn is_motion(name: &str) -> bool {
    name.starts_with("animate") || matches!(name, "set" | "discard" | "script")
}

/// Text with `%20` and alike decoded; `None` if nothing is.
fn percent_decoded(text: &str) -> Option<String> {
    let mut bytes = Vec::new();
    let mut rest = text.as_bytes();
    while let Some((&first, after)) = rest.split_first() {
        let code = after.get(..2).filter(|_| first == b'%');
        let code = code.and_then(|c| u8::from_str_radix(str::from_utf8(c).ok()?, 16).ok());
        bytes.push(code.unwrap_or(first));
        rest = code.map_or(after, |_| &after[2..]);
    }
    String::from_utf8(bytes).ok().filter(|t| t != text)
}

pub(super) fn is_svg(node: Node) -> bool {
    node.is_element() && matches!(node.tag_name().namespace(), None | Some(SVG))
}

/// The address of a reference, without blanks around it; `None` for an empty one.
fn href<'n>(node: Node<'n, '_>) -> Option<&'n str> {
    let address = attribute(node, "href").or_else(|| node.attribute((XLINK, "href")))?;
    Some(address.trim()).filter(|a| !a.is_empty())
}

/// Returns true if the conditions of an element hold in an English browser.
fn passes(node: Node) -> bool {
    let extensions = attribute(node, "requiredExtensions").map_or("", str::trim);
    let languages = attribute(node, "systemLanguage");
    (extensions.is_empty() || extensions == XHTML)
        && languages.is_none_or(|l| {
            l.split(',')
                .any(|l| matches!(l.trim().split('-').next(), Some("en" | "EN" | "En")))
        })
}

/// The elements that a fault in the drawing's root names.
pub(super) fn root_fault(name: &str) -> Error {
    content_fault(format!(
        "the file has <{name}> at its root, not <svg>; save the drawing as SVG"
    ))
}
