//! The curves of basic shapes and of path data, in double precision.

use crate::element::attribute;
use crate::reader::Place;
use crate::style::Style;
use kurbo::{BezPath, Ellipse, Line, ParamCurve, PathEl, Point, Shape, SvgArc, Vec2};
use svgtypes::{PathParser, PathSegment};

/// Curves of circles and arcs are within this part of their radius.
const ROUNDNESS: f64 = 1e-7;

/// The curve of a shape.
#[derive(Default)]
pub(crate) struct Curve {
    pub path: BezPath,
    /// Elements of the path that end within an arc, where no marker is.
    pub within_arcs: Vec<usize>,
    /// A mistake after which the path ends.
    pub mistake: Option<String>,
}

impl From<BezPath> for Curve {
    fn from(path: BezPath) -> Self {
        Self {
            path,
            ..Self::default()
        }
    }
}

/// The curve of a shape.
pub(crate) fn curve(node: roxmltree::Node, style: &Style, place: Place) -> Curve {
    let (width, height) = place.viewport;
    let x = |name: &str| style.size(name, width);
    let y = |name: &str| style.size(name, height);
    let radius = |name: &str, whole: f64| {
        let radius = style.geometry(name).map(|l| l.of(whole));
        radius.filter(|r| *r >= 0.0)
    };
    let radii = || {
        let (rx, ry) = (radius("rx", width), radius("ry", height));
        // One that is missing is as the other.
        (rx.or(ry).unwrap_or(0.0), ry.or(rx).unwrap_or(0.0))
    };
    match node.tag_name().name() {
        "rect" => {
            let (w, h) = (x("width"), y("height"));
            if w <= 0.0 || h <= 0.0 {
                return Curve::default();
            }
            let (rx, ry) = radii();
            rectangle((x("x"), y("y")), (w, h), (rx.min(0.5 * w), ry.min(0.5 * h))).into()
        }
        "circle" => {
            let r = style.size("r", place.diagonal());
            ellipse((x("cx"), y("cy")), (r, r))
        }
        "ellipse" => ellipse((x("cx"), y("cy")), radii()),
        "line" => {
            let mut path = BezPath::new();
            path.move_to((x("x1"), y("y1")));
            path.line_to((x("x2"), y("y2")));
            path.into()
        }
        "polyline" => points(attribute(node, "points").unwrap_or_default(), false),
        "polygon" => points(attribute(node, "points").unwrap_or_default(), true),
        _ => path_data(style.own.path_data.as_deref().unwrap_or_default()),
    }
}

fn ellipse(centre: (f64, f64), radii: (f64, f64)) -> Curve {
    if radii.0 <= 0.0 || radii.1 <= 0.0 {
        return Curve::default();
    }
    let tolerance = ROUNDNESS * radii.0.max(radii.1);
    Ellipse::new(centre, radii, 0.0).to_path(tolerance).into()
}

fn rectangle(corner: (f64, f64), (w, h): (f64, f64), (rx, ry): (f64, f64)) -> BezPath {
    let (x, y) = corner;
    if rx <= 0.0 || ry <= 0.0 {
        return kurbo::Rect::new(x, y, x + w, y + h).to_path(0.1);
    }
    let (right, bottom) = (x + w, y + h);
    let mut pen = Pen {
        at: Point::new(x + rx, y),
        ..Pen::default()
    };
    pen.path.move_to(pen.at);
    for (from, to) in [
        ((right - rx, y), (right, y + ry)),
        ((right, bottom - ry), (right - rx, bottom)),
        ((x + rx, bottom), (x, bottom - ry)),
        ((x, y + ry), (x + rx, y)),
    ] {
        let (from, to) = (Point::from(from), Point::from(to));
        if from != pen.at {
            pen.line(from);
        }
        pen.arc(SvgArc {
            from,
            to,
            radii: Vec2::new(rx, ry),
            x_rotation: 0.0,
            large_arc: false,
            sweep: true,
        });
    }
    pen.path.close_path();
    pen.path
}

fn points(text: &str, closed: bool) -> Curve {
    let (mut path, mut numbers, mut mistake) = (BezPath::new(), Vec::new(), None);
    for number in svgtypes::NumberListParser::from(text) {
        match number {
            Ok(v) => numbers.push(v),
            Err(_) => {
                mistake = Some("points that are damaged".to_owned());
                break;
            }
        }
    }
    if mistake.is_none() && numbers.len() % 2 == 1 {
        mistake = Some("points with a coordinate too few".to_owned());
    }
    for pair in numbers.chunks_exact(2) {
        match path.elements().is_empty() {
            true => path.move_to((pair[0], pair[1])),
            false => path.line_to((pair[0], pair[1])),
        }
    }
    if closed && !path.elements().is_empty() {
        path.close_path();
    }
    Curve {
        path,
        mistake,
        ..Curve::default()
    }
}

/// Reads path data up to the first mistake, as browsers do.
pub(crate) fn path_data(text: &str) -> Curve {
    let text = text.trim();
    let mut pen = Pen::default();
    if text.is_empty() || text == "none" {
        return Curve::default();
    }
    let mut mistake = None;
    for (i, segment) in PathParser::from(text).enumerate() {
        match segment {
            Ok(segment) => pen.draw(segment),
            Err(_) => {
                mistake = Some(format!("path data with a mistake in segment {}", i + 1));
                break;
            }
        }
    }
    Curve {
        path: pen.path,
        within_arcs: pen.within_arcs,
        mistake,
    }
}

#[derive(Default)]
struct Pen {
    path: BezPath,
    within_arcs: Vec<usize>,
    start: Point,
    at: Point,
    /// The last control point, of a cubic or a quadratic curve.
    control: Option<(bool, Point)>,
    /// The subpath was closed, and the next segment begins another one.
    closed: bool,
}

impl Pen {
    fn draw(&mut self, segment: PathSegment) {
        let (from, control) = (self.at, self.control.take());
        let base = |abs: bool| if abs { Vec2::ZERO } else { from.to_vec2() };
        let place = |abs: bool, x: f64, y: f64| Point::new(x, y) + base(abs);
        use PathSegment::{ClosePath, MoveTo};
        if self.closed && !matches!(segment, MoveTo { .. } | ClosePath { .. }) {
            self.path.move_to(from);
            self.closed = false;
        }
        let mirrored = |cubic: bool| match control {
            Some((kind, c)) if kind == cubic => from + (from - c),
            _ => from,
        };
        match segment {
            PathSegment::MoveTo { abs, x, y } => {
                self.at = place(abs, x, y);
                (self.start, self.closed) = (self.at, false);
                self.path.move_to(self.at);
            }
            PathSegment::LineTo { abs, x, y } => self.line(place(abs, x, y)),
            PathSegment::HorizontalLineTo { abs, x } => {
                self.line(Point::new(x + base(abs).x, from.y));
            }
            PathSegment::VerticalLineTo { abs, y } => {
                self.line(Point::new(from.x, y + base(abs).y));
            }
            #[rustfmt::skip]
            PathSegment::CurveTo { abs, x1, y1, x2, y2, x, y } => {
                self.cubic(place(abs, x1, y1), place(abs, x2, y2), place(abs, x, y));
            }
            PathSegment::SmoothCurveTo { abs, x2, y2, x, y } => {
                self.cubic(mirrored(true), place(abs, x2, y2), place(abs, x, y));
            }
            PathSegment::Quadratic { abs, x1, y1, x, y } => {
                self.quadratic(place(abs, x1, y1), place(abs, x, y));
            }
            PathSegment::SmoothQuadratic { abs, x, y } => {
                self.quadratic(mirrored(false), place(abs, x, y));
            }
            #[rustfmt::skip]
            PathSegment::EllipticalArc { abs, rx, ry, x_axis_rotation, large_arc, sweep, x, y } => {
                self.arc(SvgArc {
                    from,
                    to: place(abs, x, y),
                    radii: Vec2::new(rx.abs(), ry.abs()),
                    x_rotation: x_axis_rotation.to_radians(),
                    large_arc,
                    sweep,
                });
            }
            PathSegment::ClosePath { .. } => {
                if !self.closed {
                    self.path.close_path();
                }
                (self.at, self.closed) = (self.start, true);
            }
        }
    }

    fn line(&mut self, to: Point) {
        self.path.line_to(to);
        self.at = to;
    }

    fn cubic(&mut self, c1: Point, c2: Point, to: Point) {
        self.path.curve_to(c1, c2, to);
        (self.at, self.control) = (to, Some((true, c2)));
    }

    fn quadratic(&mut self, c: Point, to: Point) {
        self.path.quad_to(c, to);
        (self.at, self.control) = (to, Some((false, c)));
    }

    fn arc(&mut self, arc: SvgArc) {
        if arc.from == arc.to {
            return;
        }
        let to = arc.to;
        match kurbo::Arc::from_svg_arc(&arc) {
            Some(curve) if curve.radii.is_finite() && curve.center.is_finite() => {
                let tolerance = ROUNDNESS * curve.radii.x.max(curve.radii.y);
                let first = self.path.elements().len();
                self.path.extend(curve.append_iter(tolerance));
                let last = self.path.elements().len() - 1;
                self.within_arcs.extend(first..last);
                // The end is exact.
                if let Some(PathEl::CurveTo(.., end)) = self.path.elements_mut().last_mut() {
                    *end = to;
                }
            }
            _ => self.path.line_to(to),
        }
        self.at = to;
    }
}

/// An estimate of how often a path with many segments crosses itself, by chords in fixed random
/// pairs.
pub(crate) fn crossings(path: &BezPath) -> f64 {
    const PAIRS: u32 = 20_000;
    const FEW: usize = 600;
    let chords: Vec<Line> = path
        .segments()
        .map(|s| Line::new(s.start(), s.end()))
        .collect();
    if chords.len() < FEW {
        return 0.0;
    }
    let mut state = 1u64;
    let mut pick = || {
        state = state
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1);
        chords[(state >> 33) as usize % chords.len()]
    };
    let side = |l: Line, p: Point| (l.p1 - l.p0).cross(p - l.p0) > 0.0;
    let parted = |a: Line, b: Line| side(a, b.p0) != side(a, b.p1);
    let found = (0..PAIRS).filter(|_| {
        let (a, b) = (pick(), pick());
        parted(a, b) && parted(b, a)
    });
    // A few hits may be chance.
    let hits = found.count().saturating_sub(10);
    hits as f64 / f64::from(PAIRS) * 0.5 * (chords.len() as f64).powi(2)
}
