//! The transform of an element, from its attribute and from CSS.

use crate::notes::{Result, unsupported};
use crate::reader::{Place, Reader};
use crate::style::{Own, Reference, Style};
use crate::tree::{Node as Drawn, bounds};
use crate::value::transform::{Base, origin, property, transform};
use kurbo::{Affine, Vec2};
use roxmltree::Node;

impl Reader<'_> {
    /// The transform of an element about its content.
    pub fn transform(
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
                let what = "\"transform-box: stroke-box\"";
                return Err(unsupported(node, what, "use fill-box"));
            }
            Reference::Fill => {
                let about = bounds(content, Affine::IDENTITY).unwrap_or_default();
                (corner, size) = (about.origin().to_vec2(), (about.width(), about.height()));
            }
        }
        let fonts = style.fonts;
        let base = |css: bool| Base { fonts, size, css };
        // Values were read once with the style, so that all are valid.
        let moved = own.moved.iter().zip(Own::MOVED);
        let moved =
            moved.filter_map(|(text, name)| property(text.as_deref()?, name, base(true)).ok());
        let mut product = moved.fold(Affine::IDENTITY, |product, factor| product * factor);
        if let Some((text, css)) = &own.transform {
            product *= transform(text, base(*css)).ok().unwrap_or_default();
        }
        let usual = match node.parent_element() {
            Some(_) => Vec2::ZERO,
            None => Vec2::new(0.5 * size.0, 0.5 * size.1),
        };
        let about = own
            .origin
            .as_deref()
            .and_then(|t| origin(t, base(false)).ok());
        let about = corner + about.unwrap_or(usual);
        Ok(Affine::translate(about) * product * Affine::translate(-about))
    }
}
