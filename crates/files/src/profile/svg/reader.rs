//! Walks the elements that show, follows their references, and makes plain painted paths of them.

use super::super::paint::{self, Rgba};
use super::cascade::Sheets;
use super::color::Color;
use super::notes::{Notes, line, misled, unsupported};
use super::shapes::{Curve, curve};
use super::style::{Own, Paint, Reference, Style, Target};
use super::transform::{Base, origin, rotate, scale, transform, translate};
use super::tree::{Band, Clip, ClipShape, Group, Node as Drawn, Path, bounds};
use super::value::Value;
use super::viewport::{fitted, view_box};
use crate::content_fault;
use kurbo::{Affine, Rect, Shape, Stroke, Vec2};
use revmap::error::{Error, Result};
use roxmltree::{Node, NodeId};
use std::collections::HashMap;
use std::rc::Rc;

/// Groups and references may be nested this deep.
const MOST_NESTED: usize = 200;
/// Most elements of a drawing after references are followed.
const MOST_ELEMENTS: usize = 200_000;
/// References from gradient to gradient.
const MOST_LINKS: usize = 32;

const SVG: &str = "http://www.w3.org/2000/svg";
const XLINK: &str = "http://www.w3.org/1999/xlink";
const XHTML: &str = "http://www.w3.org/1999/xhtml";

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
}

impl Place {
    fn deeper(self) -> Self {
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
    count: usize,
}

impl<'a> Reader<'a> {
    pub fn new(document: &'a roxmltree::Document<'a>) -> Self {
        let mut notes = Notes::default();
        let mut ids = HashMap::new();
        for node in document.descendants() {
            if let Some(id) = node.attribute("id") {
                ids.entry(id).or_insert(node);
            }
        }
        Self {
            sheets: Sheets::of(document, &mut notes),
            ids,
            notes,
            open: Vec::new(),
            count: 0,
        }
    }

    pub fn by_id(&self, id: &str) -> Option<Node<'a, 'a>> {
        self.ids.get(id).copied()
    }

    /// The style of an element where it is in the document.
    pub fn style_of(&mut self, node: Node) -> Result<Style> {
        let mut ancestors: Vec<Node> = node.ancestors().filter(Node::is_element).collect();
        ancestors.reverse();
        let start = Style::default();
        ancestors
            .into_iter()
            .try_fold(start, |s, n| self.styled(n, &s))
    }

    pub fn styled(&mut self, node: Node, parent: &Style) -> Result<Style> {
        Style::of(node, parent, &self.sheets, &mut self.notes)
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
        self.count += 1;
        if self.count > MOST_ELEMENTS {
            return Err(content_fault(format!(
                "the drawing has more than {MOST_ELEMENTS} elements; simplify it"
            )));
        }
        if place.depth > MOST_NESTED {
            let what = format!("elements nested more than {MOST_NESTED} deep");
            return Err(misled(&what, node, "too many", "ungroup them"));
        }
        let style = self.styled(node, parent)?;
        if !style.own.display || style.own.opacity <= 0.0 {
            return Ok(());
        }
        let mut content = Vec::new();
        match node.tag_name().name() {
            "g" | "a" => self.children(node, &style, place, &mut content)?,
            "svg" => self.viewport(node, node, &style, place, &mut content)?,
            "use" => self.reference(node, &style, place, &mut content)?,
            "switch" => {
                let first = node.children().find(|n| is_svg(*n) && passes(*n));
                if let Some(child) = first {
                    self.element(child, &style, place.deeper(), &mut content)?;
                }
            }
            "path" | "rect" | "circle" | "ellipse" | "line" | "polyline" | "polygon" => {
                self.shape(node, &style, place, &mut content)?;
            }
            name => return self.without_outline(node, name, &style, place),
        }
        self.wrap(node, &style, place, content, out)
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
        let moves = name.starts_with("animate") || matches!(name, "set" | "discard");
        let what = match name {
            _ if moves => "an animation, which is drawn at rest",
            "script" if node.text().is_some_and(|t| !t.trim().is_empty()) => {
                "a script, which is not run"
            }
            "script" => return false,
            name if UNSEEN.contains(&name) || name.starts_with("fe") => return false,
            _ => "an element that SVG does not have, which is left out",
        };
        self.notes.warn(format!(
            "the drawing has <{name}> (line {}): {what}",
            line(node)
        ));
        false
    }

    /// Refuses elements that have no outline here, if they show.
    fn without_outline(
        &mut self,
        node: Node,
        name: &str,
        style: &Style,
        place: Place,
    ) -> Result<()> {
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
        for child in node.children().filter(Node::is_element) {
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
            true => style.clone(),
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
        let inner = Drawn::Group(Group {
            transform: fit,
            opacity: 1.0,
            clip: None,
            children,
        });
        out.push(Drawn::Group(Group {
            transform: Affine::translate(at),
            opacity: 1.0,
            clip,
            children: vec![inner],
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
        let mut inherited = style.clone();
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
            out.push(Drawn::Group(Group {
                transform: Affine::translate((at("x", width), at("y", height))),
                opacity: 1.0,
                clip: None,
                children,
            }));
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

    fn shape(
        &mut self,
        node: Node<'a, 'a>,
        style: &Style,
        place: Place,
        out: &mut Vec<Drawn>,
    ) -> Result<()> {
        if !style.visible {
            return Ok(());
        }
        for child in node.children().filter(|c| is_svg(*c)) {
            // Children of shapes are descriptions and animations.
            self.is_seen(child);
        }
        let curve = self.curve(node, style, place)?;
        if curve.path.elements().len() < 2 {
            return Ok(());
        }
        let bounds = curve.path.bounding_box();
        let (width, height) = place.viewport;
        let diagonal = (0.5 * (width * width + height * height)).sqrt();
        let thickness = style.stroke_width.of(diagonal);
        for part in style.order {
            let (shade, opacity, band) = match part {
                0 => (&style.fill, style.fill_opacity, None),
                1 if thickness > 0.0 => {
                    let band = band(node, style, &curve, thickness, diagonal);
                    (&style.stroke, style.stroke_opacity, Some(band))
                }
                1 => continue,
                _ => {
                    self.markers(node, style, place, &curve, thickness, out)?;
                    continue;
                }
            };
            if let Some((color, lightest)) = self.solid(shade, opacity, style, bounds, node)? {
                out.push(Drawn::Path(Path {
                    curve: curve.path.clone(),
                    band,
                    rule: style.fill_rule,
                    color,
                    lightest: lightest.map(|color| (color, line(node))),
                }));
            }
        }
        Ok(())
    }

    fn curve(&mut self, node: Node, style: &Style, place: Place) -> Result<Curve> {
        let curve = curve(node, style, place.viewport);
        if let Some(mistake) = &curve.mistake {
            self.notes.warn(format!(
                "the drawing has {mistake} (line {}); the path ends there, as in browsers",
                line(node)
            ));
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
            units = units.or_else(|| n.attribute("gradientUnits"));
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
        self.refuse_effects(node, &style.own)?;
        let transform = self.transform(node, style, place, &content)?;
        if transform.determinant() == 0.0 {
            return Ok(());
        }
        let clip = match &style.own.clip_path {
            Some(target) => {
                let target = target.clone();
                self.clip(&target, node, place, bounds(&content, Affine::IDENTITY))?
            }
            None => None,
        };
        if transform == Affine::IDENTITY && clip.is_none() && style.own.opacity >= 1.0 {
            out.extend(content);
        } else {
            out.push(Drawn::Group(Group {
                transform,
                opacity: style.own.opacity,
                clip,
                children: content,
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
            line(node)
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
        if own.origin.is_none() && node.parent_element().is_some() {
            // The usual origin is that of the coordinates, whatever the box is.
            return Ok(product);
        }
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
        self.open.push(clip.id());
        let style = self.style_of(clip)?;
        let (mut place, mut to_box) = (place, Affine::IDENTITY);
        if clip.attribute("clipPathUnits") == Some("objectBoundingBox") {
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
        Ok(Some(Clip {
            transform,
            shapes,
            within,
        }))
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
        self.count += 1;
        let style = self.styled(node, parent)?;
        if !style.own.display || (name != "use" && !style.visible) {
            return Ok(());
        }
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

/// The shape of an element's stroke.
fn band(node: Node, style: &Style, curve: &Curve, width: f64, diagonal: f64) -> Band {
    let mut dashes: Vec<f64> = style.dashes.iter().map(|d| d.of(diagonal)).collect();
    let mut offset = style.dash_offset.of(diagonal);
    if dashes.iter().sum::<f64>() <= 0.0 {
        dashes.clear();
    }
    if dashes.len() % 2 == 1 {
        dashes.extend_from_within(..);
    }
    let stated = node
        .attribute("pathLength")
        .and_then(|t| t.trim().parse::<f64>().ok());
    if let Some(stated) = stated.filter(|v| *v > 0.0 && !dashes.is_empty()) {
        let factor = curve.path.perimeter(1e-3 * width) / stated;
        dashes.iter_mut().for_each(|d| *d *= factor);
        offset *= factor;
    }
    let stroke = Stroke::new(width)
        .with_miter_limit(style.miter_limit)
        .with_caps(style.cap)
        .with_join(style.join);
    Band {
        style: stroke.with_dashes(offset, dashes),
        on_page: style.own.vector_effect,
    }
}

fn is_svg(node: Node) -> bool {
    node.is_element() && matches!(node.tag_name().namespace(), None | Some(SVG))
}

/// The address of a reference, without blanks around it; `None` for an empty one.
fn href<'n>(node: Node<'n, '_>) -> Option<&'n str> {
    let address = node
        .attribute("href")
        .or_else(|| node.attribute((XLINK, "href")))?;
    Some(address.trim()).filter(|a| !a.is_empty())
}

/// Returns true if the conditions of an element hold in an English browser.
fn passes(node: Node) -> bool {
    let extensions = node.attribute("requiredExtensions").map_or("", str::trim);
    let languages = node.attribute("systemLanguage");
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
