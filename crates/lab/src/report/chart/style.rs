//! Colours, markers and dashes of series. Which search has which is told elsewhere: here is what
//! there is to choose from.

/// Ink of words and axes.
pub const INK: &str = "#222222";
/// Paler ink, of what matters less.
pub const PALE: &str = "#666666";
/// Lines of the grid.
pub const GRID: &str = "#dddddd";
/// Paper.
pub const PAPER: &str = "#ffffff";

/// Colours of series: the palette of Okabe and Ito (2008), which people of every kind of colour vision
/// can tell apart. Grey takes the place of its yellow, which is too pale on white.
pub mod color {
    /// Orange.
    pub const ORANGE: &str = "#e69f00";
    /// Sky blue.
    pub const SKY: &str = "#56b4e9";
    /// Bluish green.
    pub const GREEN: &str = "#009e73";
    /// Blue.
    pub const BLUE: &str = "#0072b2";
    /// Vermilion, the one that stands out.
    pub const VERMILION: &str = "#d55e00";
    /// Reddish purple.
    pub const PURPLE: &str = "#cc79a7";
    /// Black.
    pub const BLACK: &str = "#000000";
    /// Grey.
    pub const GREY: &str = "#999999";
    /// All of them.
    pub const ALL: [&str; 8] = [VERMILION, BLUE, BLACK, GREEN, PURPLE, SKY, ORANGE, GREY];
}

/// Shapes of markers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Marker {
    /// A disk.
    Disk,
    /// A square.
    Square,
    /// A triangle that points up.
    Up,
    /// A square on its corner.
    Diamond,
    /// A star of four points, upright.
    Plus,
    /// A triangle that points down.
    Down,
    /// A star of four points, slanting.
    Cross,
    /// A star of five points.
    Star,
    /// A triangle that points to the left.
    Left,
    /// A triangle that points to the right.
    Right,
    /// A star of six points.
    Hexagram,
}

impl Marker {
    /// All shapes.
    pub const ALL: [Self; 11] = [
        Self::Disk,
        Self::Square,
        Self::Up,
        Self::Diamond,
        Self::Plus,
        Self::Down,
        Self::Cross,
        Self::Star,
        Self::Left,
        Self::Right,
        Self::Hexagram,
    ];

    /// Its corners about `(x, y)`, of about the area of a square of side `size`.
    #[must_use]
    pub fn corners(self, x: f64, y: f64, size: f64) -> Vec<(f64, f64)> {
        let ring = |corners: usize, turn: f64, radius: f64, inner: f64| -> Vec<(f64, f64)> {
            (0..corners)
                .map(|k| {
                    let angle = std::f64::consts::TAU * (k as f64 / corners as f64 + turn);
                    let radius = if k % 2 == 0 { radius } else { radius * inner };
                    (radius * angle.sin(), -radius * angle.cos())
                })
                .collect()
        };
        let corners = match self {
            Self::Disk => ring(24, 0.0, 1.1, 1.0),
            Self::Square => ring(4, 0.125, 1.35, 1.0),
            Self::Up => ring(3, 0.0, 1.5, 1.0),
            Self::Diamond => ring(4, 0.0, 1.4, 1.0),
            Self::Plus => ring(8, 0.0, 1.6, 0.45),
            Self::Down => ring(3, 0.5, 1.5, 1.0),
            Self::Cross => ring(8, 0.125, 1.6, 0.45),
            Self::Hexagram => ring(12, 0.0, 1.5, 0.577),
            Self::Star => ring(10, 0.0, 1.5, 0.45),
            Self::Left => ring(3, 0.75, 1.5, 1.0),
            Self::Right => ring(3, 0.25, 1.5, 1.0),
        };
        corners
            .into_iter()
            .map(|(dx, dy)| (x + dx * size / 2.0, y + dy * size / 2.0))
            .collect()
    }
}

/// How a line is broken.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Dash {
    /// It is not.
    Solid,
    /// Into dashes: of guides alone, fronts and prints, so that no search is taken for one.
    Guide,
    /// Into long dashes.
    Long,
    /// Into short dashes.
    Short,
    /// Into dots.
    Dots,
    /// Into dashes and dots.
    DashDot,
}

impl Dash {
    /// Lengths of dashes and gaps in turn, pixels; empty of a solid line.
    #[must_use]
    pub fn pattern(self) -> &'static [f32] {
        match self {
            Self::Solid => &[],
            Self::Guide => &[5.0, 4.0],
            Self::Long => &[12.0, 3.0],
            Self::Short => &[3.0, 2.0],
            Self::Dots => &[1.5, 3.0],
            Self::DashDot => &[8.0, 3.0, 1.5, 3.0],
        }
    }
}

/// How a series looks.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Style {
    /// Colour of its markers and lines, `#rrggbb`.
    pub color: &'static str,
    /// Shape of its markers.
    pub marker: Marker,
    /// How its lines are broken.
    pub dash: Dash,
    /// True if it is prominent: larger markers, thicker lines.
    pub heavy: bool,
    /// True if its markers are filled.
    pub filled: bool,
}

impl Style {
    /// A filled marker on a solid line.
    #[must_use]
    pub const fn new(color: &'static str, marker: Marker) -> Self {
        Self {
            color,
            marker,
            dash: Dash::Solid,
            heavy: false,
            filled: true,
        }
    }

    /// Width of its lines, pixels: thinner where markers are hollow.
    #[must_use]
    pub fn line(self) -> f64 {
        let full = if self.heavy { 2.6 } else { 1.6 };
        if self.filled { full } else { 0.7 * full }
    }

    /// The marker's corners about `(x, y)`, of the area of a square of side `size`, larger where it
    /// stands out.
    #[must_use]
    pub fn corners(self, x: f64, y: f64, size: f64) -> Vec<(f64, f64)> {
        let size = if self.heavy { 1.3 * size } else { size };
        self.marker.corners(x, y, size)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_marker_and_dash_is_another() {
        let look = |m: Marker| format!("{:.2?}", m.corners(0.0, 0.0, 10.0));
        for (i, a) in Marker::ALL.iter().enumerate() {
            assert!(Marker::ALL[..i].iter().all(|b| look(*a) != look(*b)));
        }
        let heavy = Style {
            heavy: true,
            ..Style::new(color::VERMILION, Marker::Disk)
        };
        let light = Style::new(color::VERMILION, Marker::Disk);
        assert!(heavy.line() > light.line());
        assert!(heavy.corners(0.0, 0.0, 10.0)[0].1 < light.corners(0.0, 0.0, 10.0)[0].1);
    }
}
