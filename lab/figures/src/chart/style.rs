//! Colours, markers and dashes of series, to choose from.

/// Ink of words and axes.
pub const INK: &str = "#222222";
/// Paler ink, of what matters less.
pub const PALE: &str = "#666666";
pub const GRID: &str = "#dddddd";
pub const PAPER: &str = "#ffffff";

/// Colours of series: the palette of Okabe and Ito (2008), which people of every kind of colour vision
/// can tell apart. Grey takes the place of its yellow, which is too pale on white.
pub mod color {
    pub const ORANGE: &str = "#e69f00";
    pub const SKY: &str = "#56b4e9";
    pub const GREEN: &str = "#009e73";
    pub const BLUE: &str = "#0072b2";
    pub const VERMILION: &str = "#d55e00";
    pub const PURPLE: &str = "#cc79a7";
    pub const BLACK: &str = "#000000";
    pub const GREY: &str = "#999999";
    pub const ALL: [&str; 8] = [VERMILION, BLUE, BLACK, GREEN, PURPLE, SKY, ORANGE, GREY];
}

/// The shape of a marker: corners on a ring, every second one at a part of its radius.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Marker {
    corners: u8,
    /// The place of the first corner, as a part of a turn from the top.
    turn: f64,
    radius: f64,
    inner: f64,
}

impl Marker {
    pub const DISK: Self = Self::ring(24, 0.0, 1.1, 1.0);
    pub const SQUARE: Self = Self::ring(4, 0.125, 1.35, 1.0);
    pub const UP: Self = Self::ring(3, 0.0, 1.5, 1.0);
    pub const DIAMOND: Self = Self::ring(4, 0.0, 1.4, 1.0);
    pub const PLUS: Self = Self::ring(8, 0.0, 1.6, 0.45);
    pub const DOWN: Self = Self::ring(3, 0.5, 1.5, 1.0);
    pub const CROSS: Self = Self::ring(8, 0.125, 1.6, 0.45);
    pub const STAR: Self = Self::ring(10, 0.0, 1.5, 0.45);
    pub const LEFT: Self = Self::ring(3, 0.75, 1.5, 1.0);
    pub const RIGHT: Self = Self::ring(3, 0.25, 1.5, 1.0);
    pub const HEXAGRAM: Self = Self::ring(12, 0.0, 1.5, 0.577);
    pub const ALL: [Self; 11] = [
        Self::DISK,
        Self::SQUARE,
        Self::UP,
        Self::DIAMOND,
        Self::PLUS,
        Self::DOWN,
        Self::CROSS,
        Self::STAR,
        Self::LEFT,
        Self::RIGHT,
        Self::HEXAGRAM,
    ];

    const fn ring(corners: u8, turn: f64, radius: f64, inner: f64) -> Self {
        Self {
            corners,
            turn,
            radius,
            inner,
        }
    }

    /// Its corners about `(x, y)`, of about the area of a square of side `size`.
    pub fn corners(self, x: f64, y: f64, size: f64) -> Vec<(f64, f64)> {
        let corner = |k: u8| {
            let turn = f64::from(k) / f64::from(self.corners) + self.turn;
            let (sin, cos) = (std::f64::consts::TAU * turn).sin_cos();
            let part = if k.is_multiple_of(2) { 1.0 } else { self.inner };
            let radius = self.radius * part * size / 2.0;
            (x + radius * sin, y - radius * cos)
        };
        (0..self.corners).map(corner).collect()
    }
}

/// How a line is broken: lengths of dashes and gaps in turn, pixels; empty of a solid line.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Dash(pub &'static [f32]);

impl Dash {
    pub const SOLID: Self = Self(&[]);
    /// Of guides alone, fronts and prints, so that no search is taken for one.
    pub const GUIDE: Self = Self(&[5.0, 4.0]);
    pub const LONG: Self = Self(&[12.0, 3.0]);
    pub const SHORT: Self = Self(&[3.0, 2.0]);
    pub const DOTS: Self = Self(&[1.5, 3.0]);
    pub const DASH_DOT: Self = Self(&[8.0, 3.0, 1.5, 3.0]);
}

/// How a series looks.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Style {
    /// Colour of its markers and lines, `#rrggbb`.
    pub color: &'static str,
    pub marker: Marker,
    pub dash: Dash,
    /// True if it is prominent: larger markers, thicker lines.
    pub heavy: bool,
    pub filled: bool,
}

impl Style {
    /// A filled marker on a solid line.
    pub const fn new(color: &'static str, marker: Marker) -> Self {
        Self {
            color,
            marker,
            dash: Dash::SOLID,
            heavy: false,
            filled: true,
        }
    }

    /// The look of the series of a number, for series that have none of their own.
    pub fn numbered(k: usize) -> Self {
        Self::new(
            color::ALL[k % color::ALL.len()],
            Marker::ALL[k % Marker::ALL.len()],
        )
    }

    /// Width of its lines, pixels: thinner where markers are hollow.
    pub fn line(self) -> f64 {
        let full = if self.heavy { 2.6 } else { 1.6 };
        if self.filled { full } else { 0.7 * full }
    }

    /// The marker's corners about a place, as large as a square of side `size`, or larger if heavy.
    pub fn corners(self, (x, y): (f64, f64), size: f64) -> Vec<(f64, f64)> {
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
            ..Style::new(color::VERMILION, Marker::DISK)
        };
        let light = Style::new(color::VERMILION, Marker::DISK);
        assert!(heavy.line() > light.line());
        assert!(heavy.corners((0.0, 0.0), 10.0)[0].1 < light.corners((0.0, 0.0), 10.0)[0].1);
    }
}
