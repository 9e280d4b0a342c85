//! Colours and markers of series.

/// Ink of words and axes.
pub const INK: &str = "#222222";
/// Paler ink, of what matters less.
pub const PALE: &str = "#666666";
/// Lines of the grid.
pub const GRID: &str = "#dddddd";
/// Paper.
pub const PAPER: &str = "#ffffff";

/// Okabe and Ito's colours, darkest first, without yellow, which is too pale for lines on paper.
const COLORS: [&str; 7] = [
    "#0072b2", "#d55e00", "#009e73", "#cc79a7", "#000000", "#e69f00", "#56b4e9",
];

/// Corners of each marker in a square of side 2 about the origin.
const MARKERS: usize = 8;

/// How a series looks.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Style {
    /// Its number among the series: decides colour and marker. Seven colours and eight markers give 56 different pairs.
    pub index: usize,
    /// Whether its markers are filled.
    pub filled: bool,
}

impl Style {
    /// The colour.
    #[must_use]
    pub fn color(self) -> &'static str {
        COLORS[self.index % COLORS.len()]
    }

    /// The marker's corners about `(x, y)`, of the area of a square of side `size`.
    #[must_use]
    pub fn marker(self, x: f64, y: f64, size: f64) -> Vec<(f64, f64)> {
        let regular = |corners: usize, turn: f64, radius: f64| -> Vec<(f64, f64)> {
            (0..corners)
                .map(|k| {
                    let angle = std::f64::consts::TAU * (k as f64 / corners as f64 + turn);
                    (radius * angle.sin(), -radius * angle.cos())
                })
                .collect()
        };
        let star = |points: usize, inner: f64, turn: f64, outer: f64| -> Vec<(f64, f64)> {
            (0..2 * points)
                .map(|k| {
                    let angle = std::f64::consts::TAU * (k as f64 / (2 * points) as f64 + turn);
                    let radius = if k % 2 == 0 { outer } else { outer * inner };
                    (radius * angle.sin(), -radius * angle.cos())
                })
                .collect()
        };
        let corners = match self.index % MARKERS {
            0 => regular(24, 0.0, 1.1),
            1 => regular(4, 0.125, 1.35),
            2 => regular(3, 0.0, 1.5),
            3 => regular(4, 0.0, 1.4),
            4 => star(4, 0.45, 0.125, 1.6),
            5 => regular(3, 0.5, 1.5),
            6 => star(4, 0.45, 0.0, 1.6),
            _ => star(5, 0.45, 0.0, 1.5),
        };
        corners
            .into_iter()
            .map(|(dx, dy)| (x + dx * size / 2.0, y + dy * size / 2.0))
            .collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_pair_of_colour_and_marker_is_another() {
        let look = |index| {
            let style = Style {
                index,
                filled: true,
            };
            (
                style.color(),
                format!("{:.2?}", style.marker(0.0, 0.0, 10.0)),
            )
        };
        let all: Vec<_> = (0..56).map(look).collect();
        for (i, a) in all.iter().enumerate() {
            assert!(!all[..i].contains(a), "{i}");
        }
        // Neighbours differ in both.
        for pair in all.windows(2) {
            assert!(pair[0].0 != pair[1].0 && pair[0].1 != pair[1].1);
        }
    }
}
