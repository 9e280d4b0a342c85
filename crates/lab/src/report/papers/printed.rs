//! The papers' tables as they are printed.

/// Sizes of the papers' pictures.
pub const SIZES: [(u32, u32); 2] = [(800, 600), (1366, 706)];

/// One of the papers' tables.
pub struct Printed {
    /// Its number in the article.
    pub number: usize,
    /// What it varies.
    pub title: &'static str,
    /// The letter of the parameter.
    pub letter: char,
    /// The parameter's values: `e` and `b` as fractions of the largest distance in the map.
    pub values: [f64; 3],
    /// Frames per second as printed, of each of [`SIZES`].
    pub rates: [[f64; 3]; 2],
    /// What the article says of speed as the parameter grows.
    pub claim: Trend,
}

/// How speed goes as a parameter grows.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Trend {
    /// It falls.
    Falls,
    /// It rises.
    Rises,
    /// Neither, within the interval.
    Unclear,
}

impl Trend {
    /// A word for it.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Falls => "falls",
            Self::Rises => "rises",
            Self::Unclear => "no clear change",
        }
    }
}

/// The tables as printed. Measured by the authors on an Intel Core i7-3612QM with a GeForce GT
/// 630M.
pub const TABLES: [Printed; 3] = [
    Printed {
        number: 1,
        title: "extended, e growing",
        letter: 'e',
        values: [0.25, 0.5, 0.8],
        rates: [[180.0, 170.0, 160.0], [150.0, 145.0, 130.0]],
        claim: Trend::Falls,
    },
    Printed {
        number: 2,
        title: "beveled, b growing",
        letter: 'b',
        values: [0.25, 0.5, 0.8],
        rates: [[200.0, 210.0, 230.0], [190.0, 195.0, 200.0]],
        claim: Trend::Rises,
    },
    Printed {
        number: 3,
        title: "chamfered, c growing, b = 0.8",
        letter: 'c',
        values: [0.25, 0.5, 0.7],
        rates: [[195.0, 209.0, 216.0], [174.0, 176.0, 182.0]],
        claim: Trend::Rises,
    },
];
