//! Content that is elsewhere or has a viewport of its own: `use`, `symbol`, nested `svg`.

use super::notes::misled;
use super::reader::{Place, Reader, href, passes};
use super::style::Style;
use super::tree::{Clip, Group, Node as Drawn};
use super::viewport::{fitted, view_box};
use kurbo::{Affine, Rect};
use revmap::error::Result;
use roxmltree::Node;

impl<'a> Reader<'a> {
    /// The content of an `svg` or `symbol`, whose place and size `frame` may give.
    pub fn viewport(
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
        let side = |name: &str, whole: f64| {
            let given = of_frame.geometry(name).or_else(|| style.geometry(name));
            given.map_or(whole, |l| l.of(whole))
        };
        let size = (
            side("width", place.viewport.0),
            side("height", place.viewport.1),
        );
        if !(size.0 > 0.0 && size.1 > 0.0) {
            return Ok(());
        }
        let at = match node.tag_name().name() == "svg" {
            true => place.corner(style),
            false => (0.0, 0.0),
        };
        let inner = view_box(node, &mut self.notes);
        if inner.is_some_and(|i| i.area() <= 0.0) {
            return Ok(());
        }
        let (fit, viewport) = fitted(node, inner, size);
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
    pub fn reference(
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
        inherited.context = style.as_context();
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
            let moved = Affine::translate(place.corner(style));
            out.push(Drawn::Group(Group::moved(moved, children)));
        }
        Ok(())
    }

    /// The element that a `use` refers to.
    pub fn used(&mut self, node: Node) -> Result<Option<Node<'a, 'a>>> {
        let Some(address) = href(node) else {
            return Ok(None);
        };
        let how = match address.strip_prefix('#').map(|id| self.by_id(id)) {
            None => "whose part is in another file; copy the part into the drawing",
            Some(None) => "whose part is not in the drawing; add the part or remove the element",
            Some(Some(target)) if self.open.contains(&target.id()) => {
                "which contains itself; remove the inner one"
            }
            Some(found) => return Ok(found),
        };
        let what = format!("<use href=\"{}\">", super::css::one_line(address));
        Err(misled(node, &what, how))
    }
}
