//! Clip paths: the union of their shapes, read once for each place that they are used in.

use crate::element::{attribute, is_svg, passes};
use crate::notes::{Result, misled, unsupported};
use crate::reader::{MOST_NESTED, Place, Reader, SHAPES};
use crate::style::Style;
use crate::tree::{Clip, ClipShape, Node as Drawn, Path};
use crate::value::Target;
use kurbo::{Affine, Rect, Shape};
use roxmltree::Node;

impl<'a> Reader<'a> {
    /// The clip that is referred to. Browsers ignore one that is missing.
    pub fn clip(
        &mut self,
        target: &Target,
        node: Node,
        place: Place,
        about: Option<Rect>,
    ) -> Result<Option<Clip>> {
        let Some(clip) = self.found(target, "clipPath") else {
            self.missing("clip", target, node);
            return Ok(None);
        };
        if self.open.contains(&clip.id()) {
            return Err(misled(
                clip,
                "a clip",
                "which clips itself; remove the inner one",
            ));
        }
        if self.open.len() > MOST_NESTED {
            return Err(misled(
                clip,
                "a clip",
                "which is nested too deep; remove the inner ones",
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
        let (mut inner, mut to_box) = (place, Affine::IDENTITY);
        if is_of_box {
            let about = about.unwrap_or_default();
            to_box = Affine::new([about.width(), 0.0, 0.0, about.height(), about.x0, about.y0]);
            inner.viewport = (1.0, 1.0);
        }
        let mut shapes = Vec::new();
        for child in clip.children().filter(Node::is_element) {
            self.clip_shape(child, &style, inner, Affine::IDENTITY, &mut shapes)?;
        }
        let transform = to_box * self.transform(clip, &style, inner, &[])?;
        let within = match &style.own.clip_path {
            Some(target) => self.clip(target, clip, inner, about)?.map(Box::new),
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
        let is_known = SHAPES.contains(&name) || matches!(name, "use" | "text");
        if !is_svg(node) || !is_known || !passes(node) {
            return Ok(());
        }
        self.counted()?;
        let style = self.styled(node, parent)?;
        if !style.own.display || (name != "use" && !style.visible) {
            return Ok(());
        }
        style.own.check()?;
        let first = shapes.len();
        let own = match name {
            "text" => {
                return match self.text_shows(node, &style, place.depth)? {
                    true => Err(unsupported(
                        node,
                        "a clip that is no path",
                        "clip with a path",
                    )),
                    false => Ok(()),
                };
            }
            "use" => {
                let Some(target) = self.used(node)? else {
                    return Ok(());
                };
                // A `use` in a clip refers to a shape directly.
                if matches!(target.tag_name().name(), "g" | "use" | "svg" | "symbol") {
                    return Ok(());
                }
                let own = outer * self.transform(node, &style, place, &[])?;
                let moved = own * Affine::translate(place.corner(&style));
                self.open.push(target.id());
                self.clip_shape(target, &style, place, moved, shapes)?;
                self.open.pop();
                own
            }
            _ => {
                let mut curve = self.curve(node, &style, place)?.path;
                let content = [Drawn::Path(Path::plain(curve.clone(), style.clip_rule))];
                let own = outer * self.transform(node, &style, place, &content)?;
                curve.apply_affine(own);
                shapes.push(ClipShape {
                    curve,
                    rule: style.clip_rule,
                    clip: None,
                });
                own
            }
        };
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
        let Some(target) = &style.own.clip_path else {
            return Ok(());
        };
        for shape in shapes {
            let about = transform.inverse() * &shape.curve;
            let about = (!about.is_empty()).then(|| about.bounding_box());
            let Some(mut clip) = self.clip(target, node, place, about)? else {
                return Ok(());
            };
            self.count += clip.size();
            self.counted()?;
            clip.transform = transform * clip.transform;
            clip.within = match (clip.within.take(), shape.clip.take()) {
                (within, None) => within,
                (None, Some(before)) => Some(Box::new(before)),
                (Some(_), Some(_)) => {
                    let what = "clips of clips of clips";
                    return Err(unsupported(node, what, "clip with one path"));
                }
            };
            shape.clip = Some(clip);
        }
        Ok(())
    }
}
