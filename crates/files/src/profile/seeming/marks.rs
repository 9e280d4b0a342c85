//! Thin lines beside a solid: the frame, centre lines and dimensions of a technical drawing. Each
//! would become a sheet, a tube or a disc.

use glam::DVec2;

/// A line below this part of the height is thin.
pub(crate) const THIN: f64 = 0.01;
/// What is thicker is no solid below this area, square heights.
pub(crate) const SOLID: f64 = 5e-3;

/// A thin line beside the solid.
#[derive(Clone, Debug)]
pub(crate) struct Mark {
    /// The corners of its box.
    pub low: DVec2,
    pub high: DVec2,
    pub is_straight: bool,
    /// Dashes and dots take turns, as in centre lines.
    pub has_dots: bool,
    /// Line of the file.
    pub line: Option<u32>,
}

/// A kind of lines: its name and effect, with the place between them.
type Kind = [&'static str; 2];
const FRAME: Kind = ["a frame", "becomes a closed can about the solid"];
const CENTRE_LINE: Kind = [
    "a centre line",
    "becomes a needle or a sheet beside the solid",
];
const DIMENSION: Kind = [
    "a dimension or extension line",
    "becomes a tube or a disc beside the solid",
];
const CURVE: Kind = ["a thin line", "becomes a sheet beside the solid"];

/// The lines about a solid in a box. `slack`: a distance that does not count.
pub(crate) struct Marks {
    pub all: Vec<Mark>,
    pub solid: [DVec2; 2],
    /// The axis across the drawing.
    pub axis: f64,
    pub slack: f64,
}

impl Marks {
    /// One warning for each kind. `remedy` follows it.
    pub fn warnings(&self, what: &str, remedy: &str) -> Vec<String> {
        let kind = |mark: &Mark| match mark {
            _ if !mark.is_straight => CURVE,
            _ if self.is_frame(mark) => FRAME,
            _ if mark.has_dots || self.is_on_axis(mark) || self.passes(mark) => CENTRE_LINE,
            _ => DIMENSION,
        };
        let kinds = [FRAME, CENTRE_LINE, DIMENSION, CURVE];
        let found = kinds.into_iter().filter_map(|wanted| {
            let first = self.all.iter().find(|mark| kind(mark) == wanted)?;
            let [name, effect] = wanted;
            let place = first
                .line
                .map_or(String::new(), |line| format!(" (line {line})"));
            Some(format!(
                "the {what} has {name}{place}, which {effect}; {remedy}"
            ))
        });
        found.collect()
    }

    /// Returns true for a side of a frame: there are lines along all sides of the solid.
    pub fn is_frame(&self, mark: &Mark) -> bool {
        let sides = [(0, false), (0, true), (1, false), (1, true)];
        // At the left of half a profile is the axis.
        let is_half = self.solid[0].x <= self.axis + self.slack;
        let has = |k: usize| self.all.iter().any(|m| self.is_side(m, sides[k]));
        sides.iter().any(|side| self.is_side(mark, *side)) && (is_half || has(0)) && (1..4).all(has)
    }

    /// Returns true for a line along a whole side of the solid's box and outside of it.
    fn is_side(&self, mark: &Mark, (axis, beyond): (usize, bool)) -> bool {
        let [low, high] = self.solid;
        let along = 1 - axis;
        let spans = mark.low[along] <= low[along] && mark.high[along] >= high[along];
        let is_outside = match beyond {
            false => mark.high[axis] < low[axis] - self.slack,
            true => mark.low[axis] > high[axis] + self.slack,
        };
        mark.high[axis] - mark.low[axis] <= self.slack && spans && is_outside
    }

    /// Returns true for a line through the solid's box and beyond it at both ends.
    pub fn passes(&self, mark: &Mark) -> bool {
        let [low, high] = self.solid;
        [0, 1].into_iter().any(|axis| {
            let along = 1 - axis;
            mark.high[axis] - mark.low[axis] <= self.slack
                && mark.high[axis] >= low[axis] - self.slack
                && mark.low[axis] <= high[axis] + self.slack
                && mark.low[along] < low[along] - self.slack
                && mark.high[along] > high[along] + self.slack
        })
    }

    pub fn is_on_axis(&self, mark: &Mark) -> bool {
        let off = [mark.low, mark.high].map(|p| (p.x - self.axis).abs());
        off[0].max(off[1]) <= self.slack
    }
}
