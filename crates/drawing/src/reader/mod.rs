//! Walks the elements that show, follows their references, and makes plain painted paths of them.

mod clips;
mod gradients;
mod markers;
mod moved;
mod references;
mod shapes;
mod strokes;
pub(crate) mod viewport;

use crate::css::cascade::Sheets;
use crate::element::{attribute, is_in};
use crate::element::{href, is_svg, passes};
use crate::notes::{Fault, Notes, Result, is_motion, misled, unsupported, warn_of_motion};
use crate::reader::shapes::{Curve, crossings, curve};
use crate::reader::strokes::stroked;
use crate::style::{Own, Reference, Style};
use crate::tree::{Clip, Group, Node as Drawn, Path, bounds, is_painted};
use crate::value::Target;
use crate::value::paint::Paint;
use kurbo::{Affine, BezPath, Shape};
use percent_encoding::percent_decode_str;
use roxmltree::{Node, NodeId};
use std::collections::HashMap;

/// Groups and references may be nested this deep.
pub(crate) const MOST_NESTED: usize = 200;
/// Most elements of a drawing after references are followed.
const MOST_ELEMENTS: usize = 200_000;
/// Most crossings of a path with itself.
const MOST_CROSSINGS: f64 = 1.5e5;

/// Elements that are curves.
pub(crate) const SHAPES: [&str; 7] = [
    "path", "rect", "circle", "ellipse", "line", "polyline", "polygon",
];
/// Other elements that may show something where they are.
const SEEN: &str = "g a svg use switch text image foreignObject flowRoot";
/// Elements of SVG that show nothing where they are.
const UNSEEN: &str = "defs symbol clipPath mask linearGradient radialGradient pattern marker filter style title \
    desc metadata view font font-face cursor color-profile hatch hatchpath mesh meshgradient solidcolor solidColor \
    stop tspan textPath tref glyph missing-glyph mpath meshGradient namedview";

/// The remedy for text.
const TO_PATHS: &str = "convert it to paths, or hide a label by display=\"none\"";

/// What elements show.
pub(crate) type Shown = Result<Vec<Drawn>>;

/// Where an element is: what percentages refer to, and how deep.
#[derive(Clone, Copy)]
pub(crate) struct Place {
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

    /// What percentages of lengths in no direction refer to.
    pub fn diagonal(&self) -> f64 {
        let (width, height) = self.viewport;
        (0.5 * (width * width + height * height)).sqrt()
    }

    /// The place that `x` and `y` of an element give.
    pub fn corner(&self, style: &Style) -> (f64, f64) {
        (
            style.size("x", self.viewport.0),
            style.size("y", self.viewport.1),
        )
    }
}

pub(crate) struct Reader<'a> {
    sheets: Sheets,
    ids: HashMap<&'a str, Node<'a, 'a>>,
    pub notes: Notes,
    /// Elements whose content is being read through a reference.
    pub open: Vec<NodeId>,
    /// Clips that were read, by their element and what their lengths refer to.
    pub clips: HashMap<(NodeId, [u64; 6]), Clip>,
    pub count: usize,
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
        let plain = || self.ids.get(&*percent_decode_str(id).decode_utf8().ok()?);
        self.ids.get(id).or_else(plain).copied()
    }

    /// The element `name` that is referred to.
    pub fn found(&self, target: &Target, name: &str) -> Option<Node<'a, 'a>> {
        let found = target.as_ref().ok().and_then(|id| self.by_id(id));
        found.filter(|n| n.tag_name().name() == name)
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

    pub fn children(&mut self, node: Node<'a, 'a>, style: &Style, place: Place) -> Shown {
        let mut all = Vec::new();
        for child in node.children().filter(Node::is_element) {
            all.append(&mut self.element(child, style, place.deeper())?);
        }
        Ok(all)
    }

    pub fn element(&mut self, node: Node<'a, 'a>, parent: &Style, place: Place) -> Shown {
        if !is_svg(node) || !self.is_seen(node) {
            return Ok(Vec::new());
        }
        self.counted()?;
        if place.depth > MOST_NESTED {
            let what = format!("elements nested more than {MOST_NESTED} deep");
            return Err(misled(node, &what, "too many; ungroup them"));
        }
        let style = self.styled(node, parent)?;
        if !style.own.display {
            return Ok(Vec::new());
        }
        let hidden = style.own.opacity <= 0.0 || self.vanishes(node, &style, place)?;
        let place = Place {
            shown: place.shown && !hidden,
            ..place
        };
        let open = self.open.len();
        match self.shown(node, &style, place) {
            Err(_) if !place.shown => {
                self.open.truncate(open);
                Ok(Vec::new())
            }
            other => other,
        }
    }

    /// Counts one more element.
    pub fn counted(&mut self) -> Result<()> {
        self.count += 1;
        match self.count > MOST_ELEMENTS {
            true => Err(Fault::new(format!(
                "the drawing has more than {MOST_ELEMENTS} elements, those of clips and references included; simplify it"
            ))),
            false => Ok(()),
        }
    }

    /// Returns true if an element is scaled to nothing, or clipped by an empty clip.
    #[inline(never)]
    fn vanishes(&mut self, node: Node, style: &Style, place: Place) -> Result<bool> {
        let clip = style.own.clip_path.as_ref();
        let clip = clip.and_then(|target| self.found(target, "clipPath"));
        let is_box = style.own.reference == Reference::Stroke;
        Ok(
            clip.is_some_and(|clip| clip.first_element_child().is_none())
                || (!is_box && self.transform(node, style, place, &[])?.determinant() == 0.0),
        )
    }

    /// An element that is displayed.
    fn shown(&mut self, node: Node<'a, 'a>, style: &Style, place: Place) -> Shown {
        let content = match node.tag_name().name() {
            "g" | "a" => self.children(node, style, place)?,
            "svg" => self.viewport(node, node, style, place)?,
            "use" => self.reference(node, style, place)?,
            "switch" => match node.children().find(|n| is_svg(*n) && passes(*n)) {
                Some(child) => self.element(child, style, place.deeper())?,
                None => Vec::new(),
            },
            name if SHAPES.contains(&name) => self.shape(node, style, place)?,
            name => {
                self.without_outline(node, name, style, place)?;
                return Ok(Vec::new());
            }
        };
        self.wrap(node, style, place, content)
    }

    /// Returns false for elements that show nothing, with a warning if something may be missing.
    fn is_seen(&mut self, node: Node) -> bool {
        let name = node.tag_name().name();
        if SHAPES.contains(&name) || is_in(SEEN, name) {
            return passes(node);
        }
        if !(is_in(UNSEEN, name) || name.starts_with("fe") || is_motion(name)) {
            let how = ": an element that SVG does not have, which is left out";
            self.notes.warn_at(node, &format!("<{name}>"), how);
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
        let (width, height) = place.viewport;
        let sides = || ["width", "height"].into_iter().zip([width, height]);
        let mut sides = sides().map(|(name, whole)| style.geometry(name).map(|l| l.of(whole)));
        let (shows, remedy) = match name {
            "text" | "flowRoot" => (self.text_shows(node, style, place.depth)?, TO_PATHS),
            "image" => {
                let named = style.visible && href(node).is_some();
                let shows = named && sides.all(|side| side != Some(0.0));
                (shows, "trace it to paths")
            }
            _ => {
                let filled = node.children().any(|c| c.is_element() || has_letters(c));
                let sized = sides.all(|side| side.is_some_and(|v| v > 0.0));
                (style.visible && filled && sized, TO_PATHS)
            }
        };
        match shows {
            true => Err(unsupported(node, &format!("<{name}>"), remedy)),
            false => Ok(()),
        }
    }

    /// Returns true if text has letters that are painted.
    pub fn text_shows(&mut self, node: Node, style: &Style, depth: usize) -> Result<bool> {
        let painted = |paint: &Paint, opacity: f32| {
            opacity > 0.0 && !matches!(style.resolved(paint), Paint::None)
        };
        let shown = style.visible
            && style.fonts.own > 0.0
            && (painted(&style.fill, style.fill_opacity)
                || painted(&style.stroke, style.stroke_opacity));
        let mut texts = node.children().filter(Node::is_text);
        if depth > MOST_NESTED || (shown && texts.any(has_letters)) {
            return Ok(true);
        }
        let described = |n: &Node| matches!(n.tag_name().name(), "title" | "desc" | "metadata");
        let children = node.children().filter(Node::is_element);
        for child in children.filter(|n| !described(n)) {
            let own = self.styled(child, style)?;
            let displayed = own.own.display && own.own.opacity > 0.0;
            if displayed && self.text_shows(child, &own, depth + 1)? {
                return Ok(true);
            }
        }
        Ok(false)
    }

    #[inline(never)]
    fn shape(&mut self, node: Node<'a, 'a>, style: &Style, place: Place) -> Shown {
        let plain = |curve: &BezPath| Path::plain(curve.clone(), style.fill_rule);
        let mut out = Vec::new();
        if !style.visible || !place.shown {
            let curve = curve(node, style, place).path;
            if curve.is_finite() {
                out.push(Drawn::Path(plain(&curve)));
            }
            return Ok(out);
        }
        style.own.check()?;
        let curve = self.curve(node, style, place)?;
        if curve.path.elements().len() < 2 {
            return Ok(out);
        }
        let bounds = curve.path.bounding_box();
        let has_inside = bounds.area() > 0.0 && node.tag_name().name() != "line";
        let thickness = style.stroke_width.of(place.diagonal());
        let line = self.notes.line(node);
        let mut painted = false;
        for part in style.order {
            let (shade, opacity) = match part {
                0 if has_inside => (&style.fill, style.fill_opacity),
                1 if thickness > 0.0 => (&style.stroke, style.stroke_opacity),
                0 | 1 => continue,
                _ => {
                    out.append(&mut self.markers(node, style, place, &curve, thickness)?);
                    continue;
                }
            };
            let Some((color, lightest)) = self.solid(shade, opacity, style, bounds, node)? else {
                continue;
            };
            painted = true;
            let shape = match part {
                1 => stroked((node, line), style, &curve, thickness, place)?,
                _ => plain(&curve.path),
            };
            out.push(Drawn::Path(Path {
                color,
                lightest: lightest.map(|color| (color, line)),
                ..shape
            }));
        }
        if !painted {
            out.push(Drawn::Path(plain(&curve.path)));
        }
        Ok(out)
    }

    pub fn curve(&mut self, node: Node, style: &Style, place: Place) -> Result<Curve> {
        let curve = curve(node, style, place);
        if let Some(mistake) = &curve.mistake {
            self.notes
                .warn_at(node, mistake, "; the path ends there, as in browsers");
        }
        let crossings = crossings(&curve.path);
        if crossings > MOST_CROSSINGS {
            let what = format!("a path that crosses itself about {crossings:.0} times");
            return Err(misled(node, &what, "which is too often; simplify it"));
        }
        if !curve.path.is_finite() {
            let how = "which is beyond all numbers; correct it";
            return Err(misled(node, "a coordinate", how));
        }
        Ok(curve)
    }

    /// An element's content under its transform, clip and opacity.
    #[inline(never)]
    pub fn wrap(
        &mut self,
        node: Node<'a, 'a>,
        style: &Style,
        place: Place,
        content: Vec<Drawn>,
    ) -> Shown {
        if content.is_empty() {
            return Ok(content);
        }
        let is_painted = place.shown && is_painted(&content);
        if is_painted {
            style.own.check()?;
            self.refuse_effects(node, &style.own)?;
        }
        let transform = self.transform(node, style, place, &content)?;
        if transform.determinant() == 0.0 {
            return Ok(Vec::new());
        }
        let mut clip = match style.own.clip_path.as_ref().filter(|_| is_painted) {
            Some(target) => self.clip(target, node, place, bounds(&content, Affine::IDENTITY))?,
            None => None,
        };
        if let Some(clip) = &mut clip {
            clip.crop(&content);
            self.count += clip.size();
        }
        if transform == Affine::IDENTITY && clip.is_none() && style.own.opacity >= 1.0 {
            return Ok(content);
        }
        Ok(vec![Drawn::Group(Group {
            opacity: style.own.opacity,
            clip,
            ..Group::moved(transform, content)
        })])
    }

    /// Refuses masks and filters. Browsers ignore those that are missing.
    fn refuse_effects(&mut self, node: Node, own: &Own) -> Result<()> {
        let remedy = "clip with a path, or cut the shape";
        for (name, target, remedy) in [
            ("mask", &own.mask, remedy),
            ("filter", &own.filter, "remove it"),
        ] {
            let Some(target) = target else { continue };
            if self.found(target, name).is_some() || (target.is_err() && name == "mask") {
                return Err(unsupported(node, &format!("a {name}"), remedy));
            }
            self.missing(name, target, node);
        }
        Ok(())
    }

    /// Warns of a clip, mask or filter that is missing.
    pub fn missing(&mut self, name: &str, target: &Target, node: Node) {
        let (Ok(id) | Err(id)) = target;
        let how = ", which is not in it and is ignored, as in browsers";
        self.notes.warn_at(node, &format!("a {name} \"{id}\""), how);
    }
}

fn has_letters(node: Node) -> bool {
    node.text().is_some_and(|t| !t.trim().is_empty())
}
