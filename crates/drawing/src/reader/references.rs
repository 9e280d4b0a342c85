//! Content that is elsewhere or has a viewport of its own: `use`, `symbol`, nested `svg`.

use crate::element::{href, passes};
use crate::notes::{Result, misled};
use crate::reader::viewport::{fitted, view_box};
use crate::reader::{Place, Reader, Shown};
use crate::style::Style;
use crate::tree::{Clip, Group, Node as Drawn};
use kurbo::{Affine, Rect};
use roxmltree::Node;

impl<'a> Reader<'a> {
    /// The content of an `svg` or `symbol`, whose place and size `frame` may give.
    pub fn viewport(
        &mut self,
        node: Node<'a, 'a>,
        frame: Node<'a, 'a>,
        style: &Style,
        place: Place,
    ) -> Shown {
        let of_frame = match frame == node {
            true => Box::new(style.clone()),
            false => self.style_of(frame)?,
        };
        let side = |name: &str, whole: f64| {
            let given = of_frame.geometry(name).or_else(|| style.geometry(name));
            given.map_or(whole, |l| l.of(whole))
        };
        let (w, h) = (
            side("width", place.viewport.0),
            side("height", place.viewport.1),
        );
        if !(w > 0.0 && h > 0.0) {
            return Ok(Vec::new());
        }
        let at = match node.tag_name().name() == "svg" {
            true => place.corner(style),
            false => (0.0, 0.0),
        };
        let inner = view_box(node, &mut self.notes);
        if inner.is_some_and(|i| i.area() <= 0.0) {
            return Ok(Vec::new());
        }
        let (fit, viewport) = fitted(node, inner, (w, h));
        let children = self.children(node, style, Place { viewport, ..place })?;
        if children.is_empty() {
            return Ok(children);
        }
        let clip = (!style.own.overflow).then(|| Clip::to_rect(Rect::new(0.0, 0.0, w, h)));
        let inner = Drawn::Group(Group::moved(fit, children));
        let moved = Group::moved(Affine::translate(at), vec![inner]);
        Ok(vec![Drawn::Group(Group { clip, ..moved })])
    }

    /// The content of a `use`.
    pub fn reference(&mut self, node: Node<'a, 'a>, style: &Style, place: Place) -> Shown {
        let Some(target) = self.used(node)? else {
            return Ok(Vec::new());
        };
        let mut inherited = Box::new(style.clone());
        inherited.context = style.as_context();
        self.open.push(target.id());
        let children = match target.tag_name().name() {
            "symbol" | "svg" => {
                let own = self.styled(target, &inherited)?;
                let content = match own.own.display && passes(target) {
                    true => self.viewport(target, node, &own, place.deeper())?,
                    false => Vec::new(),
                };
                self.wrap(target, &own, place, content)?
            }
            _ => self.element(target, &inherited, place.deeper())?,
        };
        self.open.pop();
        if children.is_empty() {
            return Ok(children);
        }
        let moved = Affine::translate(place.corner(style));
        Ok(vec![Drawn::Group(Group::moved(moved, children))])
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
        let what = format!("<use href=\"{}\">", crate::css::one_line(address));
        Err(misled(node, &what, how))
    }
}
