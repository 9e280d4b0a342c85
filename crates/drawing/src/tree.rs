//! A drawing as plain painted paths: references followed, styles applied, lengths in user units.

use crate::value::color::Rgba;
use kurbo::{Affine, BezPath, Rect, Shape, Stroke};

/// The inside of a path.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FillRule {
    /// Winding number other than 0.
    NonZero,
    /// Odd winding number.
    EvenOdd,
}

/// A drawing's page and content.
#[derive(Debug)]
pub struct Drawing {
    /// Width and height of the page in CSS pixels.
    pub size: (f64, f64),
    /// Maps the page to the coordinates of the outermost `viewBox`.
    pub to_user: Affine,
    /// What is painted, the lowest first.
    pub content: Vec<Node>,
    /// Features that are drawn otherwise than meant, one sentence each.
    pub warnings: Vec<String>,
}

impl Drawing {
    /// Returns true if anything is translucent.
    #[must_use]
    pub fn has_translucency(&self) -> bool {
        any(&self.content, &|node| match node {
            Node::Group(group) => group.opacity < 1.0,
            Node::Path(path) => {
                path.color[3] < 1.0 || path.lightest.is_some_and(|(color, _)| color[3] < 1.0)
            }
        })
    }
}

/// A part of a drawing.
#[derive(Debug)]
pub enum Node {
    /// Nodes that belong together.
    Group(Group),
    /// One fill or stroke.
    Path(Path),
}

/// Nodes that are moved, clipped and shown together.
#[derive(Debug)]
pub struct Group {
    /// Maps the group's coordinates to its parent's.
    pub transform: Affine,
    /// From 0 to 1, of all children together.
    pub opacity: f32,
    /// What shows of it.
    pub clip: Option<Clip>,
    /// The lowest first.
    pub children: Vec<Node>,
    /// Markers are no geometry of the shape that has them.
    pub is_marker: bool,
}

/// One fill or stroke.
#[derive(Debug)]
pub struct Path {
    /// In the coordinates of its group.
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
pub struct Band {
    /// Width, dashes, caps and joins.
    pub style: Stroke,
    /// The width is in pixels of the page (`vector-effect="non-scaling-stroke"`).
    pub on_page: bool,
    /// The element's line.
    pub line: u32,
}

/// The union of shapes, cut by a further clip.
#[derive(Clone, Debug)]
pub struct Clip {
    /// Maps the clip's coordinates to those of the clipped group.
    pub transform: Affine,
    /// What shows is in one of these.
    pub shapes: Vec<ClipShape>,
    /// What shows is in this one, too.
    pub within: Option<Box<Clip>>,
}

/// A shape of a clip.
#[derive(Clone, Debug)]
pub struct ClipShape {
    /// In the coordinates of the clip.
    pub curve: BezPath,
    /// Its inside.
    pub rule: FillRule,
    /// Cuts it.
    pub clip: Option<Clip>,
}

impl Clip {
    /// Number of shapes, with those of further clips.
    pub(crate) fn size(&self) -> usize {
        let of = |clip: &Self| clip.size();
        let shapes = self
            .shapes
            .iter()
            .map(|s| 1 + s.clip.as_ref().map_or(0, of));
        shapes.sum::<usize>() + self.within.as_deref().map_or(0, of)
    }

    /// Keeps the shapes near the geometry of `content`, if nothing is painted outside of it.
    pub(crate) fn crop(&mut self, content: &[Node]) {
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
    pub(crate) fn to_rect(rect: Rect) -> Self {
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
    pub(crate) fn plain(curve: BezPath, rule: FillRule) -> Self {
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
    pub(crate) fn moved(transform: Affine, children: Vec<Node>) -> Self {
        Self {
            transform,
            opacity: 1.0,
            clip: None,
            children,
            is_marker: false,
        }
    }
}

/// Returns true if `is` is true for any of the nodes or of those in them.
fn any(nodes: &[Node], is: &dyn Fn(&Node) -> bool) -> bool {
    let within = |node: &Node| matches!(node, Node::Group(group) if any(&group.children, is));
    nodes.iter().any(|node| is(node) || within(node))
}

/// Returns true if anything is painted.
pub(crate) fn is_painted(nodes: &[Node]) -> bool {
    any(nodes, &|node| match node {
        Node::Group(_) => false,
        Node::Path(path) => path.color[3] > 0.0 || path.lightest.is_some(),
    })
}

/// Returns true if paint may reach beyond the geometry: strokes and markers.
fn exceeds(nodes: &[Node]) -> bool {
    any(nodes, &|node| match node {
        Node::Group(group) => group.is_marker,
        Node::Path(path) => path.band.is_some(),
    })
}

/// Removes geometry that is not painted.
pub(crate) fn prune(nodes: &mut Vec<Node>) {
    nodes.retain_mut(|node| {
        if let Node::Group(group) = node {
            prune(&mut group.children);
        }
        is_painted(std::slice::from_ref(node))
    });
}

/// The box about the geometry of nodes, painted or not, without strokes and clips.
pub(crate) fn bounds(nodes: &[Node], transform: Affine) -> Option<Rect> {
    let boxes = nodes.iter().filter_map(|node| match node {
        Node::Group(group) if group.is_marker => None,
        Node::Group(group) => bounds(&group.children, transform * group.transform),
        Node::Path(path) if path.curve.elements().len() < 2 => None,
        Node::Path(path) => Some((transform * &path.curve).bounding_box()),
    });
    boxes.reduce(|a, b| a.union(b))
}
