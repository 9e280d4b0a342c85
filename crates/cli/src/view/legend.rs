//! The scale beside a picture in false colours: the colours that the picture has, with numbers.

use revmap_bench::report::pictures::STEPS;
use revmap_compare::{EMPTY, GHOST, MISSED, Scale, ramp};

/// Colours with their values.
pub struct Legend {
    /// The quantity and its unit.
    pub title: &'static str,
    /// A bar of colours.
    pub bar: Option<Bar>,
    /// Single colours with their meaning.
    pub keys: Vec<([u8; 3], &'static str)>,
}

/// A bar of colours with ticks.
pub struct Bar {
    /// The colour at a place from 0 to 1.
    pub color: fn(f64) -> [u8; 3],
    /// Places from 0 to 1, each with its value.
    pub ticks: Vec<(f64, String)>,
}

impl Bar {
    fn logarithmic(scale: Scale, values: &[f64]) -> Self {
        let last = values.len().saturating_sub(1);
        let tick = |(n, value): (usize, &f64)| {
            // The ends of the scale stand for all values beyond them.
            let sign = match n {
                0 if *value < 1.0 => "≤ ",
                _ if n == last => "≥ ",
                _ => "",
            };
            (scale.place(*value), format!("{sign}{value}"))
        };
        Self {
            ticks: values.iter().enumerate().map(tick).collect(),
            color: ramp,
        }
    }
}

/// The grey of a distance, at a place from the nearest (0) to the farthest hit (1).
pub fn grey(place: f32) -> [u8; 3] {
    [(255.0 - 215.0 * place) as u8; 3]
}

impl Legend {
    pub fn steps() -> Self {
        Self {
            title: "look-ups or patches\nper pixel",
            bar: Some(Bar::logarithmic(STEPS, &[1.0, 4.0, 16.0, 64.0, 128.0])),
            keys: vec![(EMPTY, "none")],
        }
    }

    pub fn errors() -> Self {
        let values = [0.001, 0.01, 0.1, 1.0, 10.0];
        Self {
            title: "depth error, h/512",
            bar: Some(Bar::logarithmic(Scale::DEPTH, &values)),
            keys: vec![(MISSED, "missed pixel"), (GHOST, "ghost pixel")],
        }
    }

    /// Distances of the nearest and the farthest hit, world units.
    pub fn depth([near, far]: [f32; 2]) -> Self {
        let value = |place: f32| {
            let distance = near + place * (far - near);
            (f64::from(place), format!("{distance:.3}"))
        };
        let hits = near <= far;
        Self {
            title: "distance from the eye,\nworld units",
            bar: hits.then(|| Bar {
                color: |place| grey(place as f32),
                ticks: [0.0, 0.25, 0.5, 0.75, 1.0].map(value).into(),
            }),
            keys: Vec::new(),
        }
    }

    pub fn normals() -> Self {
        let [low, middle, high] = [-1.0, 0.0, 1.0].map(level);
        Self {
            title: "unit normal,\nworld axes",
            bar: None,
            keys: vec![
                ([high, middle, middle], "+x"),
                ([low, middle, middle], "−x"),
                ([middle, high, middle], "+y"),
                ([middle, low, middle], "−y"),
                ([middle, middle, high], "+z"),
                ([middle, middle, low], "−z"),
            ],
        }
    }
}

/// The level of a colour channel for a coordinate of a normal.
pub fn level(coordinate: f32) -> u8 {
    (127.5 + 127.5 * coordinate) as u8
}
