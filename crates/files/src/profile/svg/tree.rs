//! A drawing as plain painted paths: references followed, styles applied, lengths in user units.

use super::super::paint::Rgba;
use kurbo::{Affine, BezPath, Rect, Shape, Stroke};
use revmap::profile::FillRule;

/// A drawing's page and content.
#[derive(Debug)]
pub(in crate::profile) struct Drawing {
    /// Width and height of the page in CSS pixels.
    pub size: (f64, f64),
    /// Maps the page to the coordinates of the outermost `viewBox`.
    pub to_user: Affine,
    pub content: Vec<Node>,
    /// Features that are drawn otherwise than meant, one sentence each.
    pub warnings: Vec<String>,
}

#[derive(Debug)]
pub(in crate::profile) enum Node {
    Group(Group),
    Path(Path),
}

#[derive(Debug)]
pub(in crate::profile) struct Group {
    /// Maps the group's coordinates to its parent's.
    pub transform: Affine,
    pub opacity: f32,
    pub clip: Option<Clip>,
    pub children: Vec<Node>,
    /// Markers are no geometry of the shape that has them.
    pub is_marker: bool,
}

#[derive(Debug)]
pub(in crate::profile) struct Path {
    pub curve: BezPath,
    /// The stroke that is painted; `None` for the fill.
    pub band: Option<Band>,
    /// Inside of the fill.
    pub rule: FillRule,
    /// The colour, or the darkest colour of a gradient; transparent for geometry without paint.
    pub color: Rgba,
    /// The lightest colour of a gradient from dark to light, and its line.
    pub lightest: Option<(Rgba, u32)>,
}

/// The shape of a stroke.
#[derive(Debug)]
pub(in crate::profile) struct Band {
    pub style: Stroke,
    /// The width is in pixels of the page (`vector-effect="non-scaling-stroke"`).
    pub on_page: bool,
    /// The element's line.
    pub line: u32,
}

/// The union of shapes, cut by a further clip.
#[derive(Clone, Debug)]
pub(in crate::profile) struct Clip {
    /// Maps the clip's coordinates to those of the clipped group.
    pub transform: Affine,
    pub shapes: Vec<ClipShape>,
    pub within: Option<Box<Clip>>,
}

#[derive(Clone, Debug)]
pub(in crate::profile) struct ClipShape {
    pub curve: BezPath,
    pub rule: FillRule,
    pub clip: Option<Clip>,
}

impl Clip {
    /// Number of shapes, with those of further clips.
    pub fn size(&self) -> usize {
        let of = |clip: &Self| clip.size();
        let shapes = self
            .shapes
            .iter()
            .map(|s| 1 + s.clip.as_ref().map_or(0, of));
        shapes.sum::<usize>() + self.within.as_deref().map_or(0, of)
    }

    /// Keeps the shapes near the geometry of `content`, if nothing is painted outside of it.
    pub fn crop(&mut self, content: &[Node]) {
        let Some(area) = bounds(content, Affine::IDENTITY).filter(|_| !exceeds(content)) else {
            return;
        };
        let transform = self.transform;
        self.shapes.retain(|shape| {
            let own = (transform * &shape.curve).bounding_box();
            own.x0 <= area.x1 && own.x1 >= area.x0 && own.y0 <= area.y1 && own.y1 >= area.y0
        });
    }

    /// A clip to a rectangle.
    pub fn to_rect(rect: Rect) -> Self {
        let shape = ClipShape {
            curve: rect.to_path(0.1),
            rule: FillRule::NonZero,
            clip: None,
        };
        Self {
            transform: Affine::IDENTITY,
            shapes: vec![shape],
            within: None,
        }
    }
}

impl Path {
    /// The geometry of a fill without paint.
    pub fn plain(curve: BezPath, rule: FillRule) -> Self {
        Self {
            curve,
            band: None,
            rule,
            color: [0.0; 4],
            lightest: None,
        }
    }
}

impl Group {
    /// A group that moves its children and does no more.
    pub fn moved(transform: Affine, children: Vec<Node>) -> Self {
        Self {
            transform,
            opacity: 1.0,
            clip: None,
            children,
            is_marker: false,
        }
    }
}

/// Returns true if anything is painted.
pub(super) fn is_painted(nodes: &[Node]) -> bool {
    nodes.iter().any(|node| match node {
        Node::Group(group) => is_painted(&group.children),
        Node::Path(path) => path.color[3] > 0.0 || path.lightest.is_some(),
    })
}

/// Returns true if paint may reach beyond the geometry: strokes and markers.
fn exceeds(nodes: &[Node]) -> bool {
    nodes.iter().any(|node| match node {
        Node::Group(group) => group.is_marker || exceeds(&group.children),
        Node::Path(path) => path.band.is_some(),
    })
}

/// Removes geometry that is not painted.
pub(super) fn prune(nodes: &mut Vec<Node>) {
    nodes.retain_mut(|node| {
        if let Node::Group(group) = node {
            prune(&mut group.children);
        }
        is_painted(std::slice::from_ref(node))
    });
}

/// The box about the geometry of nodes, painted or not, without strokes and clips.
pub(super) fn bounds(nodes: &[Node], transform: Affine) -> Option<Rect> {
    let boxes = nodes.iter().filter_map(|node| match node {
        Node::Group(group) if group.is_marker => None,
        Node::Group(group) => bounds(&group.children, transform * group.transform),
        Node::Path(path) if path.curve.elements().len() < 2 => None,
        Node::Path(path) => Some((transform * &path.curve).bounding_box()),
    });
    boxes.reduce(|a, b| a.union(b))
}

/// Returns true if anything is translucent.
pub(in crate::profile) fn has_translucency(nodes: &[Node]) -> bool {
    nodes.iter().any(|node| match node {
        Node::Group(group) => group.opacity < 1.0 || has_translucency(&group.children),
        Node::Path(path) => {
            path.color[3] < 1.0 || path.lightest.is_some_and(|(color, _)| color[3] < 1.0)
        }
    })
}
